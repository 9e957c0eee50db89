#include <cmath>
#include <limits>
#include <sstream>

#include "studies.hpp"
#include "study/publish.hpp"
#include "support/digest.hpp"
#include "support/error.hpp"

using namespace talus;
using namespace talus::fixtures;

namespace {

/// The table that a study of these records writes.
std::string table_of(const std::vector<Record>& records) {
  const TemporaryDirectory directory;
  write_tables({directory.path()}, plan(2000000), records, {});
  return content(directory / "realizations.csv");
}

/// The message with which reading `text` is refused.
std::string refusal(const std::string& text) {
  const TemporaryDirectory directory;
  const auto path = directory / "t.csv";
  write(path, text);
  try {
    read_csv(path, "index");
  } catch (const IoError& e) {
    return e.what();
  }
  return "accepted";
}

const std::string head =
    "index,status,influence_zone_m,front_connected_m,front_mass_99_m,front_mass_999_m,centre_of_mass_x_m,mean_friction_"
    "angle_deg,captured_variance,"
    "steps,wall_clock_s,digest,reason,verdict,verdict_reasons,lower_bounds,front_at_thickness_m,left_domain,"
    "front_thickness_m\n";

/// The header of version 0.1.0.
const std::string head_0_1_0 = head.substr(0, head.find(",verdict")) + "\n";

}  // namespace

/// A table with the FNV-1a hash of each line after it.
std::string with_checksums(const std::string& table) {
  std::istringstream in(table);
  std::string line, all;
  std::getline(in, line);
  all = line + ",checksum\n";
  while (std::getline(in, line)) all += line + "," + hex_digits(fnv1a64(line)) + "\n";
  return all;
}

TEST(Csv, OneLineForEachRecord) {
  Record r = done(3, 34.5);
  r.measures.centre_of_mass_x = 0.1 + 0.2;  // 17 digits
  r.left_domain = 2;
  r.verdict = Verdict::doubtful;
  r.objections = "left_terrain: 2 of 5 left";
  r.lower_bounds = "influence_zone_m centre_of_mass_x_m";
  EXPECT_EQ(
      table_of({r, failed(7, "diverged: at step 12, \"fast\"\nreally"), failed_record(8, "invalid result: a: b")}),
      with_checksums(head +
                     "3,done,34.5,34.2,33.8,34.1,0.30000000000000004,24.7,0.25,1003,1.5,0000000000000013,,doubtful,"
                     "\"left_terrain: 2 of 5 left\",\"influence_zone_m centre_of_mass_x_m\",33.9,2,0.6\n"
                     "7,failed,,,,,,,,,,,\"diverged: at step 12, \"\"fast\"\" really\",,,,,,\n"
                     "8,failed,,,,,,,,,,,\"invalid result: a: b\",invalid,\"a: b\",,,,\n"));
}

TEST(Csv, ALineThatWasChangedIsFound) {
  const std::string good = table_of({done(3, 34.5), done(4, 35.5)});
  for (const auto& [from, to] : {std::pair{"34.5", "94.5"}, {"\n4,", "\n5,"}, {"done,35.5", "done,3.55"}}) {
    std::string changed = good;
    changed.replace(changed.find(from), std::string(from).size(), to);
    EXPECT_NE(refusal(changed).find("does not agree with its checksum"), std::string::npos) << changed;
  }
  EXPECT_NE(refusal(good.substr(0, good.size() - 3)).find("t.csv:3 does not agree"), std::string::npos);
}

TEST(Csv, ReadsBackExactly) {
  const TemporaryDirectory directory;
  const auto path = directory / "t.csv";
  Record r = done(3, 100.0 / 3.0);
  r.wall_clock = 1e-300;
  r.left_domain = 2;
  r.verdict = Verdict::doubtful;
  r.objections = "left_terrain: 2 of 5 left; still_moving: yes";
  r.lower_bounds = "influence_zone_m front_mass_999_m";
  write(path, table_of({r, failed(7, "a, \"b\"; c"), failed_record(8, "invalid result: a: b"), done(1000000, -0.125)}));
  const std::vector<Record> back = read_csv(path, "index");
  ASSERT_EQ(back.size(), 4u);
  EXPECT_EQ(back[0].left_domain, 2.0);
  EXPECT_EQ(back[0].verdict, Verdict::doubtful);
  EXPECT_EQ(back[0].objections, r.objections);
  EXPECT_EQ(back[0].lower_bounds, r.lower_bounds);
  EXPECT_TRUE(back[0].is_lower_bound(*find_measure("front_mass_999_m")));
  EXPECT_FALSE(back[0].is_lower_bound(*find_measure("front_mass_99_m")));
  EXPECT_EQ(back[2].verdict, Verdict::invalid);
  EXPECT_EQ(back[2].objections, "a: b");
  EXPECT_TRUE(back[0].done);
  EXPECT_EQ(back[0].measures.influence_zone, 100.0 / 3.0);
  EXPECT_EQ(back[0].measures.front_mass_999, 100.0 / 3.0 - 0.4);
  EXPECT_EQ(back[0].mean_phi_deg, r.mean_phi_deg);
  EXPECT_EQ(back[0].captured_variance, 0.25);
  EXPECT_EQ(back[0].steps, 1003);
  EXPECT_EQ(back[0].wall_clock, 1e-300);
  EXPECT_EQ(back[0].digest, r.digest);
  EXPECT_FALSE(back[1].done);
  EXPECT_EQ(back[1].index, 7);
  EXPECT_EQ(back[1].reason, "a, \"b\"; c");
  EXPECT_EQ(back[3].index, 1000000);
  EXPECT_EQ(table_of(back), content(path));
}

TEST(Csv, AMeasureWithoutAValueIsAnEmptyCell) {  // which a run had not, or which it was recorded before
  const TemporaryDirectory directory;
  Record r = done(3, 34.5);
  r.measures.front_mass_999 = r.measures.front_at_thickness = std::numeric_limits<double>::quiet_NaN();
  write(directory / "t.csv", table_of({r}));
  EXPECT_EQ(content(directory / "t.csv").find("nan"), std::string::npos);
  const std::vector<Record> back = read_csv(directory / "t.csv", "index");
  EXPECT_TRUE(std::isnan(back.at(0).measures.front_mass_999));
  EXPECT_TRUE(std::isnan(back[0].measures.front_at_thickness));
  EXPECT_EQ(back[0].front_thickness, r.front_thickness);
  EXPECT_EQ(back[0].measures.centre_of_mass_x, r.measures.centre_of_mass_x);
}

TEST(Csv, ReadsTheTablesOfVersion010) {
  const TemporaryDirectory directory;
  write(directory / "t.csv", head_0_1_0 +
                                 "3,done,34.5,34.2,33.8,34.1,12,24.7,0.25,1003,1.5,0000000000000013,\n"
                                 "7,failed,,,,,,,,,,,\"diverged: at step 12\"\n");
  const std::vector<Record> back = read_csv(directory / "t.csv", "index");
  ASSERT_EQ(back.size(), 2u);
  EXPECT_EQ(back[0].measures.centre_of_mass_x, 12.0);
  EXPECT_EQ(back[0].digest, "0000000000000013");
  EXPECT_TRUE(std::isnan(back[0].left_domain));
  EXPECT_TRUE(std::isnan(back[0].measures.front_at_thickness));
  EXPECT_TRUE(std::isnan(back[0].front_thickness));
  EXPECT_EQ(back[0].verdict, Verdict::not_assessed);
  EXPECT_EQ(back[0].objections, "");
  EXPECT_EQ(back[1].reason, "diverged: at step 12");
  EXPECT_EQ(back[1].verdict, Verdict::not_assessed);
}

TEST(Csv, AMeasureThatTheTableLacksHasNoValue) {
  const TemporaryDirectory directory;
  std::string header = head;
  header.erase(header.find("front_mass_999_m,"), std::string("front_mass_999_m,").size());
  write(directory / "t.csv", header + "3,done,34.5,34.2,33.8,12,24.7,0.25,1003,1.5,d,,sound,,,33.9,0,0.6\n");
  const std::vector<Record> back = read_csv(directory / "t.csv", "index");
  EXPECT_TRUE(std::isnan(back.at(0).measures.front_mass_999));
  EXPECT_EQ(back[0].measures.centre_of_mass_x, 12.0);
  EXPECT_EQ(back[0].left_domain, 0.0);
  EXPECT_EQ(back[0].verdict, Verdict::sound);
}

TEST(Csv, AcceptsLineEndsOfOtherSystems) {
  const TemporaryDirectory directory;
  write(directory / "t.csv", "index" + head.substr(5, head.size() - 6) + "\r\n3,failed,,,,,,,,,,,\"x\",,,,,,\r\n");
  EXPECT_EQ(read_csv(directory / "t.csv", "index").front().reason, "x");
}

TEST(Csv, NumbersThatNoRunHasAreRefusedWithRowAndColumn) {
  const auto row = [](const std::string& index, const std::string& zone, const std::string& steps) {
    return refusal(head + index + ",done," + zone + ",1,1,1,1,1,1," + steps + ",1,d,,,,,,,\n");
  };
  EXPECT_EQ(row("3", "1e12", "1"), "accepted");
  for (const char* zone : {"1e300", "-1e300", "1.1e12"})
    EXPECT_NE(row("3", zone, "1")
                  .find("t.csv:2 field 3 (influence_zone_m): " + std::string(zone) +
                        " is out of range; allowed -1e12 to 1e12"),
              std::string::npos)
        << row("3", zone, "1");
  for (const char* zone : {"inf", "-inf", "nan", "1e309"})
    EXPECT_NE(row("3", zone, "1").find("field 3 (influence_zone_m): \"" + std::string(zone) + "\" is not a number"),
              std::string::npos);
  EXPECT_NE(row("3", "1", "9223372036854775807").find("field 10 (steps): 9223372036854775807 is out of range"),
            std::string::npos);
  for (const char* index : {"-1", "1000000000"})
    EXPECT_NE(row(index, "1", "1").find("t.csv:2 has the index " + std::string(index) + ", which no study has"),
              std::string::npos);
}

TEST(Csv, NamesFileLineAndFault) {
  const std::string good = head + csv_line(done(3, 34.5));
  EXPECT_NE(refusal("").find("t.csv is empty"), std::string::npos);
  EXPECT_NE(refusal("a,b\n").find("t.csv:1 is not the header of a table of Talus: the column \"a\" is unknown"),
            std::string::npos);
  EXPECT_NE(refusal("index,status,steps,steps\n").find("the column \"steps\" stands there twice"), std::string::npos);
  EXPECT_NE(refusal("index,status\n").find("the column \"influence_zone_m\" is missing"), std::string::npos);
  EXPECT_NE(refusal(head_0_1_0.substr(0, 40) + "\n").find("is unknown"), std::string::npos);  // cut off
  EXPECT_NE(refusal(head + "3,done,1,1,1,1,1,1,1,1,1,d,,fine,,,,,\n").find("t.csv:2 has the unknown verdict \"fine\""),
            std::string::npos);
  EXPECT_NE(refusal(good + "4,done,1\n").find("t.csv:3 has 3 fields instead of 19"), std::string::npos);
  EXPECT_NE(refusal(good + "3,failed,,,,,,,,,,,x,,,,,,\n").find("t.csv:3 has the index 3 out of order, or twice"),
            std::string::npos);
  EXPECT_NE(refusal(head + "3,lost,,,,,,,,,,,x,,,,,,\n").find("t.csv:2 has the status \"lost\""), std::string::npos);
  EXPECT_NE(refusal(head + "3,done,far,1,1,1,1,1,1,1,1,d,,,,,,,\n")
                .find("t.csv:2 field 3 (influence_zone_m): \"far\" is not a number"),
            std::string::npos);
  EXPECT_NE(refusal(head + "3,done,nan,1,1,1,1,1,1,1,1,d,,,,,,,\n").find("\"nan\" is not a number"), std::string::npos);
  EXPECT_NE(refusal(head + "3,failed,,,,,,,,,,,\"x\n").find("t.csv:2 has 0 fields"),
            std::string::npos);  // an open quote
}
