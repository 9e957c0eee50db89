#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <ostream>

#include "case/vertices.hpp"
#include "temporary_directory.hpp"

namespace talus {
namespace {

std::string complaint(const std::string& csv) {
  Faults faults;
  read_csv(csv, "f.csv", faults);
  return faults.empty() ? "" : ConfigError(faults.all()).what();
}

/// ASCII text as UTF-16 without a mark.
std::string utf16(const std::string& text, bool big_endian) {
  std::string bytes;
  for (const char c : text) bytes += big_endian ? std::string{'\0', c} : std::string{c, '\0'};
  return bytes;
}

struct Dialect {
  const char* name;
  std::string text;
};
void PrintTo(const Dialect& dialect, std::ostream* out) { *out << dialect.name; }

class CsvDialects : public ::testing::TestWithParam<Dialect> {};

TEST_P(CsvDialects, GiveTheSameVertices) {
  const std::vector<Vec2> expected = {{0, 1.5}, {2, -3}, {4.25, 0}};
  Faults faults;
  EXPECT_EQ(read_csv(GetParam().text, "f.csv", faults).points, expected) << GetParam().text;
  EXPECT_TRUE(faults.empty()) << ConfigError(faults.all()).what();
}

const Dialect dialects[] = {
    {"commas", "0,1.5\n2,-3\n4.25,0\n"},
    {"no_newline_at_the_end", "x,y\n0,1.5\n2,-3\n4.25,0"},
    {"semicolons_and_crlf", "x;y\r\n0;1.5\r\n\r\n2;-3\r\n4.25;0\r\n"},
    {"tabs_mark_and_remarks", "\xEF\xBB\xBFx\ty\n# remark\n0\t1.5\n 2 \t -3 \n4.25\t0"},
    {"quotation_marks_and_signs", "\"x\",\"y\"\n\"0\",+1.5\n2e0,-0.3e1\n4.25,0\n"},
    {"blanks", "x y\n0 1.5\n2   -3\n  4.25\t0\n"},
    {"blanks_after_commas", "x, y\n0, 1.5\n2, -3\n4.25, 0\n"},
    {"blanks_before_commas", "x ,y\n0 ,1.5\n2 ,-3\n4.25 ,0\n"},
    {"decimal_commas", "x;y\n0,0;1,5\n2,00;-3,0\n4,25;0\n"},
    {"decimal_commas_between_tabs", "0\t1,5\n2\t-3\n4,25\t0\n"},
    {"decimal_commas_between_blanks", "0 1,5\n2 -3\n4,25 0\n"},
    {"decimal_commas_in_quotation_marks", "\"0\",\"1,5\"\n\"2\",\"-3\"\n\"4,25\",\"0\"\n"},
    {"carriage_returns_alone", "x,y\r0,1.5\r2,-3\r4.25,0\r"},
    {"utf16_little_endian", "\xFF\xFE" + utf16("x;y\r\n0;1,5\r\n2;-3\r\n4,25;0\r\n", false)},
    {"utf16_big_endian", "\xFE\xFF" + utf16("x\ty\n0\t1.5\n2\t-3\n4.25\t0\n", true)},
    {"utf16_without_a_mark", utf16("0,1.5\n2,-3\n4.25,0\n", false)},
    {"latin1_header", "Entfernung;H\xF6he\n0;1,5\n2;-3\n4,25;0\n"},
    {"several_headers", "Section A-A\nsurveyed 2021-05-04\nchainage_m;elevation_m\n\n0;1.5\n2;-3\n4.25;0\n"},
    {"a_line_of_units", "Chainage;Elevation\n[m];[m]\n0;1.5\n2;-3\n4.25;0\n"},
    {"header_as_a_remark", "# station z code\n0 1.5 7\n2 -3 7\n4.25 0 7\n"},
    {"elevation_first", "Elevation (m a.s.l.),Distance [m]\n1.5,0\n-3,2\n0,4.25\n"},
    {"more_columns", "id,CHAINAGE,code,Height_m\nP1,0,7,1.5\nP2,2,8,-3\nP3,4.25,9,0\n"},
    {"x_and_y_before_others", "station,x,y\n100,0,1.5\n200,2,-3\n300,4.25,0\n"},
    {"remarks_in_some_rows", "x,y,remark\n0,1.5\n2,-3,road\n4.25,0,\n"},
    {"empty_cells_at_the_end", "x;y;;\n0;1,5;;\n2;-3;;\n4,25;0;;\n;;;\n"}};

INSTANTIATE_TEST_SUITE_P(, CsvDialects, ::testing::ValuesIn(dialects), [](const auto& one) { return one.param.name; });

TEST(ReadCsv, SaysWhatItRead) {
  const auto form = [](const std::string& csv) {
    Faults none;
    return read_csv(csv, "f.csv", none).form;
  };
  EXPECT_EQ(form("0,1\n2,3\n"), "columns 1 and 2, separated by commas");
  EXPECT_EQ(form("id\tElevation (m)\tChainage\n1\t0\t1,5\n2\t3\t4\n"),
            "columns \"Chainage\" and \"Elevation (m)\", separated by tabs, decimal commas");
  EXPECT_EQ(form("elevation;p\n0;1\n2;3\n"), "columns \"p\" and \"elevation\", separated by semicolons");
}

TEST(ReadCsv, HasOneFaultForAllLinesOfAKind) {
  EXPECT_EQ(complaint("x,y\n0,1\n\n0,a\n"), "f.csv:4: \"a\" is not a number");
  EXPECT_EQ(complaint("0,1\n1,2,3\n4\n5,6\n"), "f.csv:2: has 3 columns, expected 2 (and 1 more line)");
  EXPECT_EQ(complaint("0,1\na,2\n1,b\nc,3\n4,1e9\n"),
            "f.csv:2: \"a\" is not a number (and 2 more lines)\n"
            "f.csv:5: 1e9 is out of range; unit m, allowed >= -1e+08 and <= 1e+08");
  EXPECT_EQ(complaint("0,1\ninf,2\n"), "f.csv:2: \"inf\" is not a number");
  EXPECT_EQ(
      complaint("no,station,z\n1,0+00,1\n2,0+12.5,3\n"),
      "f.csv:2: \"0+00\" is not a number, a station; the distance must be one number, in metres (and 1 more line)");
  EXPECT_EQ(complaint("0,1\n1e+3x,3\n"), "f.csv:2: \"1e+3x\" is not a number");
  EXPECT_EQ(complaint("0,1\n2,3\nx,y\n"), "f.csv:3: \"x\" is not a number") << "a header comes before the numbers";
  EXPECT_EQ(complaint("0,a\n1,2\n3,4\n"), "f.csv:1: \"a\" is not a number") << "a row with one number is no header";
  EXPECT_EQ(complaint("0,1\n\"2,3\n4,5\n"), "f.csv:2: has a quotation mark that is not closed");
}

TEST(ReadCsv, NamesTheFirstLineWhereNoRowHasTwoNumbers) {
  const std::string none =
      "f.csv: has no row of two numbers, distance and elevation in metres, separated by comma, semicolon, tab or "
      "blanks";
  const std::string station = ", a station; the distance must be one number, in metres";
  EXPECT_EQ(complaint("a,b\n"), none);
  EXPECT_EQ(complaint(""), none);
  EXPECT_EQ(complaint("x|y\n0|20\n10|15\n"), none + "; line 2 reads \"0|20\"");
  EXPECT_EQ(complaint("# 2021\nstation,elevation\n0+000.00,20\n"), none + "; line 3 reads \"0+000.00,20\"" + station);
}

TEST(ReadCsv, RefusesFeetHoweverTheyAreNamed) {
  const auto refused = [](const std::string& header) {
    return complaint(header + "\n0,20\n60,5\n").find("; metres are needed") != std::string::npos;
  };
  for (const char* header :
       {"Station (US survey ft),Elev (US survey ft)", "x,Elevation in US survey feet", "x',y'", "x,height (in)",
        "All dimensions in feet\nx,y", "# Elevations: US ft\nx,y", "x_ft,y_m", "Station,Elevation\n[m],[ft]"})
    EXPECT_TRUE(refused(header)) << header;
  for (const char* header :
       {"x (m),Elevation in m", "Foot of the slope\nx,y", "Converted from feet to metres\nx,y", "Elevations in m\nx,y"})
    EXPECT_EQ(complaint(std::string(header) + "\n0,20\n60,5\n"), "") << header;
}

TEST(ReadCsv, RefusesDepths) {
  const auto message = [](const std::string& column) {
    return "f.csv:1: column \"" + column + "\" is a depth or a thickness; the elevation is needed, upwards in metres";
  };
  for (const char* column : {"depth", "Depth (m)", "depth_below_ground_m", "height_of_cover", "height (m bgl)"})
    EXPECT_EQ(complaint("chainage," + std::string(column) + "\n0,20\n10,15\n"), message(column));
  EXPECT_EQ(complaint("x,elevation,depth\n0,20,1\n10,15,2\n"), "") << "a depth beside the elevation";
}

TEST(ReadCsv, LeavesARepeatedPointOut) {
  Faults faults;
  const Vertices v = read_csv("x,y\n0,20\n10,15\n10,15\n10,15\n10,5\n20,5\n10,15\n", "f.csv", faults);
  EXPECT_TRUE(faults.empty());
  EXPECT_EQ(v.points, (std::vector<Vec2>{{0, 20}, {10, 15}, {10, 5}, {20, 5}, {10, 15}})) << "only one after the other";
  EXPECT_EQ(v.lines, (std::vector<int>{2, 3, 6, 7, 8}));
  EXPECT_EQ(v.form, "columns \"x\" and \"y\", separated by commas, 2 repeated points left out");
}

TEST(ReadCsv, RefusesColumnsThatItCannotTell) {
  const std::string names =
      "(distance: x, distance, chainage, station or offset; elevation: y, z, elevation or height)";
  EXPECT_EQ(complaint("0,1,2\n3,4,5\n"), "f.csv:1: has 3 columns and no header that names two of them " + names +
                                             "; decimal commas need another separator than a comma");
  EXPECT_EQ(complaint("a;b;c\n0;1;2\n3;4;5\n"), "f.csv:2: has 3 columns and no header that names two of them " + names);
  for (const char* header : {"x,y,z", "distance,x,y,elevation", "chainage,offset,height", "x,z,elevation"}) {
    const std::string row = std::string(header).find("distance") == 0 ? "\n1,2,3,4\n" : "\n1,2,3\n";
    EXPECT_NE(complaint(header + row).find("f.csv:1: has several columns of distance or elevation: "),
              std::string::npos)
        << header;
  }
  EXPECT_EQ(complaint("Chainage (ft),Elevation (ft)\n0,1\n"),
            "f.csv:1: column \"Chainage (ft)\" is in ft; metres are needed");
  EXPECT_EQ(complaint("x,y\nm,mm\n0,1\n"), "f.csv:2: column \"mm\" is in mm; metres are needed");
  EXPECT_EQ(complaint("0;1.5\n1;2.5\n1.000;3,5\n"),
            "f.csv:3: mixes decimal points and decimal commas, or has separators of thousands");
}

TEST(ReadCsv, NamesNoData) {
  const std::string rest = " stands for no data; remove the vertex or give the elevation";
  for (const char* code : {"nan", "NaN", "", "N/A", "1e20", "-3.40282347e+38", "1.70141e38"})
    EXPECT_EQ(complaint(std::string("x,y,code\n0,1,1\n1,") + code + ",1\n2,3,1\n"),
              "f.csv:3: elevation \"" + std::string(code) + "\"" + rest);
}

TEST(ReadCsv, KnowsTheLineOfEachVertex) {
  Faults faults;
  const Vertices v = read_csv("x,y\n\n0,1\n# remark\n2,3\n", "f.csv", faults);
  EXPECT_EQ(v.location(0), "f.csv:3");
  EXPECT_EQ(v.location(1), "f.csv:5");
}

TEST(ReadCsv, StopsAtItsLimit) {
  std::string text;
  for (std::size_t k = 0; k <= most_vertices; ++k) text += "0,0\n";
  EXPECT_EQ(complaint(text), "f.csv: has more than 20000 vertices");
}

/// The faults of a bed given inline or as a CSV file in a directory.
std::vector<Fault> faults_of_bed(const Json& terrain, const std::filesystem::path& directory = "/nonexistent") {
  Faults faults;
  ObjectReader in(terrain, "/terrain", faults);
  read_vertices(in, "bed", {2, most_vertices}, directory, {"The bed."});
  return faults.all();
}

TEST(ReadVertices, RefusesNoData) {
  const auto bed = [](double elevation) { return Json{{"bed_m", {{0, 100}, {10, 90}, {20, elevation}, {30, 95}}}}; };
  for (const double code : {-9999.0, -99999.0, -32768.0, -32767.0, 9999.0, 99999.0}) {
    const auto faults = faults_of_bed(bed(code));
    ASSERT_EQ(faults.size(), 1u) << code;
    EXPECT_EQ(faults[0].pointer, "/terrain/bed_m/2");
    EXPECT_NE(faults[0].message.find(" stands for no data"), std::string::npos) << faults[0].message;
  }
  EXPECT_EQ(faults_of_bed(bed(-7777)).size(), 1u) << "far below both neighbours";
  EXPECT_EQ(faults_of_bed(bed(1096)).size(), 1u) << "1,001 m above the higher neighbour";
  EXPECT_EQ(faults_of_bed(bed(1094)).size(), 0u);
  EXPECT_EQ(faults_of_bed({{"bed_m", {{0, 0}, {1000, 1500}, {2000, 0}}}}).size(), 0u) << "a mountain";
  EXPECT_EQ(faults_of_bed({{"bed_m", {{0, 3000}, {1, 0}, {2, -1}}}}).size(), 0u) << "a cliff has one high side";
  const auto two = faults_of_bed({{"bed_m", {{0, -9999}, {10, -9999}, {20, 1}}}});
  ASSERT_EQ(two.size(), 1u);
  EXPECT_EQ(two[0].pointer, "/terrain/bed_m/0");
  EXPECT_NE(two[0].message.find("(and 1 more vertex)"), std::string::npos);
}

TEST(ReadVertices, TakesFilesBelowTheCaseOnly) {
  for (const char* name : {"../case.csv", "/etc/passwd", "a/../../b.csv", "a//b.csv", "a/", "..", ".", ".hidden",
                           "a/.hidden", "", "a\\b.csv"}) {
    const auto faults = faults_of_bed({{"bed_csv", name}}, "/");
    ASSERT_EQ(faults.size(), 1u) << name;
    EXPECT_NE(faults[0].message.find("is not the name of a CSV file beside the case"), std::string::npos) << name;
  }
}

TEST(ReadVertices, FollowsNoLinkOutOfTheDirectory) {
  namespace fs = std::filesystem;
  const test::TemporaryDirectory base;
  const fs::path here = base.path() / "case";
  fs::create_directories(here / "survey");
  std::ofstream(here / "survey" / "bed.csv") << "0,1\n2,3\n";
  std::ofstream(base.path() / "secret.csv") << "0,1\n2,3\n";
  fs::create_symlink("survey/bed.csv", here / "inside.csv");
  fs::create_symlink(base.path() / "secret.csv", here / "outside.csv");
  fs::create_directory_symlink(base.path(), here / "up");
  for (const char* name : {"survey/bed.csv", "inside.csv"})
    EXPECT_TRUE(faults_of_bed({{"bed_csv", name}}, here).empty()) << name;
  for (const char* name : {"outside.csv", "up/secret.csv"}) {
    const auto faults = faults_of_bed({{"bed_csv", name}}, here);
    ASSERT_EQ(faults.size(), 1u) << name;
    EXPECT_NE(faults[0].message.find("outside the case's directory"), std::string::npos) << faults[0].message;
  }
}

}  // namespace
}  // namespace talus
