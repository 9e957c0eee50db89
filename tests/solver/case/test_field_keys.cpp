// Keys of random_field: covariance, lengths, data, trend, and the default of cell_average.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

#include "case/data_table.hpp"
#include "documents.hpp"
#include "temporary_directory.hpp"

namespace talus {
namespace {

using test::faults_of;

Json field(const Json& keys) {
  Json section = {{"correlation_length_m", 4}, {"cov_tan_phi", 0.3}};
  section.update(keys);
  for (const auto& [key, value] : keys.items())
    if (value.is_null()) section.erase(key);
  return test::with("/random_field", section);
}

FieldSpec spec_of(const Json& document) { return *test::load(document).value.field; }

/// The only fault, or all of them in one line.
std::string fault(const Json& keys) {
  std::string all;
  for (const std::string& line : faults_of(field(keys))) all += line + "\n";
  return all;
}

TEST(FieldKeys, ReachTheirMembers) {
  const FieldSpec f = spec_of(field({{"covariance", "matern_5_2"},
                                     {"dip_deg", -30},
                                     {"nugget", 0.2},
                                     {"trend_deg_per_m", 0.5},
                                     {"data", {{3.0, 4.0, 25.0, 1.5}, {4.0, 5.0, 20.0, 0.0}}}}));
  EXPECT_EQ(f.covariance, Covariance::matern_5_2);
  EXPECT_DOUBLE_EQ(f.dip, -std::numbers::pi / 6);
  EXPECT_EQ(f.nugget, 0.2);
  EXPECT_DOUBLE_EQ(f.trend, 0.5 * std::numbers::pi / 180);
  ASSERT_EQ(f.data.size(), 2u);
  EXPECT_EQ(f.data[0].x, (Vec2{3, 4}));
  EXPECT_DOUBLE_EQ(f.data[0].value, 25 * std::numbers::pi / 180);
  EXPECT_DOUBLE_EQ(f.data[0].error, 1.5 * std::numbers::pi / 180);
}

// theta/ell: 2, 2, sqrt(pi), 4/sqrt(3), 16/(3 sqrt(5)), 1.
TEST(FieldKeys, ScaleOfFluctuationStandsForTheCorrelationLength) {
  const auto ell = [](const char* family) {
    return spec_of(field({{"covariance", family}, {"correlation_length_m", nullptr}, {"scale_of_fluctuation_m", 6}}))
        .ell_x;
  };
  EXPECT_EQ(ell("exponential"), 3);
  EXPECT_DOUBLE_EQ(ell("squared_exponential"), 6 / std::sqrt(std::numbers::pi));
  EXPECT_DOUBLE_EQ(ell("matern_3_2"), 6 / (4 / std::sqrt(3.0)));
  EXPECT_EQ(ell("cosine_exponential"), 6);
  const FieldSpec two = spec_of(
      field({{"correlation_length_m", nullptr}, {"scale_of_fluctuation_x_m", 6}, {"scale_of_fluctuation_y_m", 5}}));
  EXPECT_EQ(two.ell_x, 3);
  EXPECT_EQ(two.ell_y, 2.5);
}

TEST(FieldKeys, LengthsInOneFormOnly) {
  EXPECT_NE(
      fault({{"scale_of_fluctuation_m", 6}}).find("/random_field/correlation_length_m: is given beside scale_of_"),
      std::string::npos);
  EXPECT_NE(fault({{"correlation_length_m", nullptr}, {"scale_of_fluctuation_x_m", 6}})
                .find("/random_field/scale_of_fluctuation_y_m: is missing"),
            std::string::npos);
  EXPECT_NE(fault({{"correlation_length_m", nullptr}}).find("/random_field/correlation_length_m: is missing"),
            std::string::npos);
}

// 4 spacings of 0.5 m; along the axes on which the field varies.
// Undrained soil has no friction that could vary.
TEST(FieldKeys, FrictionOfUndrainedSoilIsRefusedOrLeftOut) {
  const auto of = [](Json field, bool mixed) {
    Json document = test::with("/random_field", std::move(field));
    document["material"] = {{"name", "clay"}, {"density_kg_m3", 1800}, {"undrained_strength_kPa", 10}};
    if (!mixed) return document;
    document["slide"]["outlines"] = Json::parse(R"([
      {"outline_m": [[0, 5], [5, 2.5], [5, 8], [0, 8]]},
      {"outline_m": [[5, 2.5], [10, 0], [12, 0], [5, 8]],
       "material": {"name": "sand", "density_kg_m3": 2000, "friction_angle_deg": 30}}])");
    return document;
  };
  const auto properties = [](const Json& stated) { return Json{{"correlation_length_m", 4}, {"properties", stated}}; };
  const Json friction = properties({{"friction", {{"mean_deg", 20}, {"cov", 0.1}}}});
  const auto first = [&](const Json& document) { return faults_of(document).at(0); };
  EXPECT_NE(first(of(friction, false)).find("/random_field/properties/friction: varies friction in undrained soil, "),
            std::string::npos);
  EXPECT_NE(first(of(properties({{"friction", {{"mean_deg", 20}, {"cov", 0.1}, {"material", "clay"}}}}), true))
                .find("(phi = 0): \"clay\" is undrained"),
            std::string::npos);
  EXPECT_NE(first(of(properties({{"undrained_strength", {{"cov", 0.1}}}}), false)).find("is called cohesion here"),
            std::string::npos);
  for (const Json& field : {friction, Json{{"correlation_length_m", 4}, {"log_stdev", 0.2}, {"log_mean", -0.8}}}) {
    const LoadedCase loaded = test::load(of(field, true));
    const auto left_out = [](const Fault& f) { return f.message.find("without friction: \"clay\"") != f.message.npos; };
    EXPECT_EQ(std::ranges::count_if(loaded.warnings, left_out), 1) << field.dump();
    Json with_datum = field;
    with_datum["data"] = {{2.0, 6.0, 25.0, 1.0}};
    EXPECT_NE(first(of(with_datum, true)).find("/random_field/data/0: is a friction angle in the material \"clay\""),
              std::string::npos);
  }
}

TEST(FieldKeys, AveragesOverCellsUnderFourSpacingsUnlessToldOtherwise) {
  const auto averages = [](Json keys) { return spec_of(field(std::move(keys))).cell_average; };
  EXPECT_FALSE(averages({{"correlation_length_m", 2}}));
  EXPECT_TRUE(averages({{"correlation_length_m", 1.99}}));
  EXPECT_FALSE(averages({{"correlation_length_m", 1.99}, {"cell_average", false}}));
  EXPECT_TRUE(averages({{"correlation_length_m", 4}, {"cell_average", true}}));
  const Json flat = {{"correlation_length_m", nullptr}, {"correlation_length_x_m", 9}, {"correlation_length_y_m", 1}};
  EXPECT_TRUE(averages(flat));
  Json along = flat;
  along["direction"] = "x";
  EXPECT_FALSE(averages(along));
}

// Defaults leave no trace: the hash of a case that was written before these keys stays.
TEST(FieldKeys, DefaultsAreNotRecorded) {
  const Json plain = test::load(field(Json::object())).resolved.at("random_field");
  for (const char* key : {"covariance", "dip_deg", "nugget", "trend_deg_per_m", "data"})
    EXPECT_FALSE(plain.contains(key)) << key;
  EXPECT_EQ(test::load(field({{"covariance", "exponential"}, {"dip_deg", 0}, {"nugget", 0}})).hash,
            test::load(field(Json::object())).hash);
}

TEST(FieldKeys, BadDataAreRefusedWhereTheyStand) {
  const auto with_data = [](Json data) { return fault({{"data", std::move(data)}}); };
  EXPECT_NE(with_data({{30, 5, 24, 1}}).find("/random_field/data/0: (30, 5) lies outside"), std::string::npos);
  EXPECT_NE(
      with_data({{3, 4, 24, 1}, {3, 4, 40, 1}}).find("/random_field/data/1: 40 deg contradicts /random_field/data/0"),
      std::string::npos);
  EXPECT_EQ(with_data({{3, 4, 24, 1}, {3, 4, 26, 1}}), "");
  EXPECT_NE(with_data({{3, 4, 24, 0}, {3, 4, 24.1, 0}}).find("contradicts"), std::string::npos);
  EXPECT_NE(with_data({{3, 4, 24, -1}}).find("/random_field/data/0/3: -1 is out of range"), std::string::npos);
  EXPECT_NE(with_data({{3, 4, 0, 1}}).find("/random_field/data/0/2: 0 is out of range"), std::string::npos);
  EXPECT_NE(with_data({{3, 4, 24}}).find("/random_field/data/0: [3,4,24] is not [x, y, value, error]"),
            std::string::npos);
  EXPECT_NE(with_data(Json::array()).find("/random_field/data: has 0 data"), std::string::npos);
  EXPECT_NE(fault({{"cov_tan_phi", 0}, {"data", {{3, 4, 24, 1}}}}).find("/random_field/data: cannot be met"),
            std::string::npos);
}

TEST(FieldKeys, ATrendKeepsTheMedianAngleInRange) {
  EXPECT_EQ(fault({{"trend_deg_per_m", -5}}), "");  // 5.5 m at most: 30 to 2.5 deg
  EXPECT_NE(
      fault({{"trend_deg_per_m", -6}}).find("/random_field/trend_deg_per_m: makes a median friction angle of -3 deg"),
      std::string::npos)
      << fault({{"trend_deg_per_m", -6}});
  EXPECT_NE(fault({{"trend_deg_per_m", 10.0}, {"log_mean", 0.5}, {"log_stdev", 0.2}, {"cov_tan_phi", nullptr}})
                .find("/random_field/trend_deg_per_m"),
            std::string::npos);
}

TEST(FieldKeys, ProductModesAreForTheSeparableExponential) {
  EXPECT_NE(
      fault({{"covariance", "matern_3_2"}, {"truncation", "diagonal"}}).find("/random_field/truncation: \"diagonal\""),
      std::string::npos);
  EXPECT_NE(fault({{"covariance", "matern_3_2"}, {"root_intervals", "paper"}}).find("/random_field/root_intervals"),
            std::string::npos);
}

/// Friction and cohesion with these keys, and others of random_field.
Json properties(const Json& friction, const Json& cohesion, const Json& others = Json::object()) {
  Json keys = {{"cov_tan_phi", nullptr}, {"properties", {{"friction", friction}, {"cohesion", cohesion}}}};
  keys.update(others);
  Json document = field(keys);
  document["material"]["cohesion_kPa"] = 5;
  return document;
}

/// Whether one of the faults begins with the text.
bool has_fault(const Json& document, const std::string& start) {
  const auto faults = faults_of(document);
  return std::ranges::any_of(faults, [&](const std::string& line) { return line.starts_with(start); });
}

const std::string of_cohesion = "/random_field/properties/cohesion/data/0";

TEST(FieldKeys, DataOfAPropertyInItsUnit) {
  const FieldSpec f =
      spec_of(properties({{"cov", 0.1}}, {{"cov", 0.3}, {"data", {{3, 4, 6, 0.5}}}}, {{"data", {{3, 4, 25, 1}}}}));
  ASSERT_EQ(f.data.size(), 2u);
  EXPECT_EQ(f.data[0].property, Property::cohesion);
  EXPECT_DOUBLE_EQ(f.data[0].value, 6e3);
  EXPECT_DOUBLE_EQ(f.data[0].error, 500);
  EXPECT_EQ(f.data[1].property, Property::friction);
  const FieldSpec under = spec_of(properties({{"cov", 0.1}, {"data", {{3, 4, 25, 1}}}}, {{"cov", 0.3}}));
  EXPECT_EQ(under.data, std::vector<FieldDatum>{f.data[1]});
}

TEST(FieldKeys, DataOfAPropertyThatCannotBeMet) {
  const Json soft = {{"cov", 0.1}}, datum = {{3, 4, 6, 0.5}};
  const auto cohesion = [&](Json keys) {
    keys["data"] = datum;
    return properties(soft, keys);
  };
  EXPECT_TRUE(faults_of(cohesion({{"cov", 0.3}})).empty());
  EXPECT_TRUE(has_fault(cohesion({{"cov", 0.3}, {"varies", "once"}}), of_cohesion + ": cannot be met"));
  EXPECT_TRUE(has_fault(cohesion({{"marginal", "constant"}, {"mean_kPa", 6}}), of_cohesion + ": cannot be met"));
  EXPECT_TRUE(
      has_fault(cohesion({{"marginal", "uniform"}, {"low_kPa", 7}, {"high_kPa", 9}}),
                of_cohesion + ": cannot be met: 6 kPa lies outside the distribution of cohesion, 7 kPa to 9 kPa"));
  EXPECT_TRUE(has_fault(properties(soft, {{"cov", 0.3}, {"data", {{3, 4, -1, 0}}}}), of_cohesion + "/2: -1 is out of"));
  EXPECT_TRUE(has_fault(properties(soft, {{"cov", 0.3}, {"data", {{3, 4, 6, 0.1}, {3, 4, 9, 0.1}}}}),
                        "/random_field/properties/cohesion/data/1: 9 kPa contradicts " + of_cohesion + ", 6 kPa"));
  EXPECT_TRUE(
      faults_of(properties({{"cov", 0.1}, {"data", {{3, 4, 25, 0}}}}, {{"cov", 0.3}, {"data", datum}})).empty());
  Json alone = properties(soft, {{"cov", 0.3}}, {{"data", {{3, 4, 25, 1}}}});
  alone["random_field"]["properties"].erase("friction");
  EXPECT_TRUE(has_fault(alone, "/random_field/data/0: cannot be met: properties does not state friction"));
  EXPECT_TRUE(
      has_fault(properties({{"cov", 0.1}, {"data", {{3, 4, 25, 0}}}}, {{"cov", 0.3}}, {{"data", {{3, 4, 25, 1}}}}),
                "/random_field/data: is given beside properties.friction.data"));
}

TEST(FieldKeys, ATrendNeedsRandomFriction) {
  Json document = properties({{"cov", 0.1}}, {{"cov", 0.3}}, {{"trend_deg_per_m", 0.5}});
  EXPECT_TRUE(faults_of(document).empty());
  document["random_field"]["trend_deg_per_m"] = -9;
  EXPECT_TRUE(has_fault(document, "/random_field/trend_deg_per_m: makes a median friction angle of"));
  document["random_field"]["properties"].erase("friction");
  EXPECT_TRUE(has_fault(document, "/random_field/trend_deg_per_m: needs properties.friction"));
}

DataTable table(const std::string& text, std::string* faults = nullptr, Property property = Property::friction) {
  LineFaults found("bore.csv");
  const DataTable out = read_data_table(text, 1000, property, found);
  Faults all;
  found.report(all);
  if (faults != nullptr) *faults = all.empty() ? "" : all.all()[0].pointer + ": " + all.all()[0].message;
  return out;
}

TEST(DataTable, ColumnsByNameAndByOrder) {
  const DataTable named = table("Borehole;phi (deg);chainage (m);standard error;elevation (m)\nB1;24,5;3,25;1;4\n");
  ASSERT_EQ(named.rows.size(), 1u);
  EXPECT_EQ(named.rows[0].cells, (std::array<std::string, 4>{"3.25", "4", "24.5", "1"}));
  EXPECT_EQ(named.rows[0].line, 2);
  const DataTable plain = table("# CPT 7\n3 4 24.5\n");
  ASSERT_EQ(plain.rows.size(), 1u);
  EXPECT_EQ(plain.rows[0].cells, (std::array<std::string, 4>{"3", "4", "24.5", ""}));
}

// A log with columns of several properties serves each of them.
TEST(DataTable, ColumnsOfTheProperty) {
  const std::string log = "x,y,phi (deg),error of phi,c (kPa),error of c\n1,2,30,1.5,6,0.5\n";
  EXPECT_EQ(table(log).rows[0].cells, (std::array<std::string, 4>{"1", "2", "30", "1.5"}));
  EXPECT_EQ(table(log, nullptr, Property::cohesion).rows[0].cells, (std::array<std::string, 4>{"1", "2", "6", "0.5"}));
  std::string faults;
  EXPECT_TRUE(table("x,y,phi\n1,2,30\n", &faults, Property::cohesion).rows.empty());
  EXPECT_NE(faults.find("bore.csv:1: has no column of this property"), std::string::npos) << faults;
}

TEST(DataTable, RefusesWhatItCannotTell) {
  std::string faults;
  table("1,2\n", &faults);
  EXPECT_EQ(faults.find("bore.csv: has no row of three numbers"), 0u) << faults;
  table("a,b,c,d,e\n1,2,3,4,5\n", &faults);
  EXPECT_NE(faults.find("bore.csv:2: has 5 columns and no header"), std::string::npos);
  table("x,depth,value\n1,2,3\n", &faults);
  EXPECT_NE(faults.find("bore.csv:1: column \"depth\" is a depth"), std::string::npos) << faults;
  table("x,y (ft),value\n1,2,3\n", &faults);
  EXPECT_NE(faults.find("bore.csv:1: column \"y (ft)\" is in ft"), std::string::npos);
  table("x,y,phi (rad)\n1,2,3\n", &faults);
  EXPECT_NE(faults.find("is in radians"), std::string::npos);
  table("x,y,value,phi\n1,2,3,4\n", &faults);
  EXPECT_NE(faults.find("two columns of one kind"), std::string::npos);
}

TEST(FieldKeys, DataOfAFileAreRecordedInline) {
  const test::TemporaryDirectory directory;
  std::ofstream(directory.path() / "bore.csv") << "x;y;value;error\n3;4;24,5;1\n4;5;20;0,5\n";
  const Json document = field({{"data_csv", "bore.csv"}});
  const LoadedCase loaded = load_case(document, directory.path());
  EXPECT_EQ(loaded.resolved.at("random_field").at("data"), Json::parse("[[3.0,4.0,24.5,1.0],[4.0,5.0,20.0,0.5]]"));
  EXPECT_FALSE(loaded.resolved.at("random_field").contains("data_csv"));
  EXPECT_EQ(test::load(loaded.resolved).hash, loaded.hash);
  EXPECT_EQ(test::load(loaded.resolved).value.field, loaded.value.field);
  std::ofstream(directory.path() / "bore.csv") << "x;y;value;error\n3;4;24,5;-1\n4;five;20;0,5\n";
  try {
    load_case(document, directory.path());
    ADD_FAILURE() << "no error";
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.faults.at(0).pointer, "bore.csv:2");
    EXPECT_EQ(error.faults.at(1).pointer, "bore.csv:3");
  }
}

// On a national grid the data move with the section.
TEST(FieldKeys, DataMoveToLocalCoordinates) {
  Json far = field({{"data", {{2'000'003.0, 4.0, 25.0, 1.5}}}});
  far["terrain"]["bed_m"] = {{2e6, 5}, {2e6 + 10, 0}, {2e6 + 40, 0}};
  far["slide"]["outlines"][0]["outline_m"] = {{2e6, 5}, {2e6 + 10, 0}, {2e6 + 12, 0}, {2e6 + 5, 8}, {2e6, 8}};
  EXPECT_EQ(spec_of(far).data[0].x, (Vec2{3, 4}));
}

}  // namespace
}  // namespace talus
