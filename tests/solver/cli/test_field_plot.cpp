#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "program.hpp"

namespace talus {
namespace {

using nlohmann::json;
using test::Outcome;
using test::talus;

const std::string case_file = TALUS_SOURCE_DIR "/solver/cases/field-check.json";

struct Row {
  double x, y, phi_deg, tan_phi;
};

std::vector<Row> read_field(const std::filesystem::path& path) {
  std::istringstream lines(read_file(path, std::size_t{16} << 20));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "x_m,y_m,friction_angle_deg,tan_phi");
  std::vector<Row> rows;
  while (std::getline(lines, line)) {
    Row row{};
    EXPECT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf", &row.x, &row.y, &row.phi_deg, &row.tan_phi), 4);
    rows.push_back(row);
  }
  return rows;
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(FieldVerb, CsvHoldsEveryParticleAndTheSummaryAgrees) {
  const test::TemporaryDirectory directory;
  const Outcome outcome =
      talus({"field", case_file, "--realization", "3", "--seed", "42", "--json", "--out", directory / "a.csv"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::vector<Row> rows = read_field(directory / "a.csv");
  const json summary = json::parse(outcome.out);
  ASSERT_EQ(rows.size(), 4141u);
  double sum = 0, lo = 90, hi = 0;
  for (const Row& row : rows) {
    EXPECT_NEAR(std::tan(row.phi_deg * M_PI / 180), row.tan_phi, 1e-12);
    sum += row.phi_deg;
    lo = std::min(lo, row.phi_deg);
    hi = std::max(hi, row.phi_deg);
  }
  EXPECT_EQ(summary["particles"], 4141);
  EXPECT_EQ(summary["terms"], 5);
  const double captured = summary["captured_variance"];
  EXPECT_NEAR(summary["cov_tan_phi"], std::sqrt(std::expm1(captured * 0.2289 * 0.2289)), 1e-12);
  EXPECT_EQ(summary["realization"], 3);
  EXPECT_EQ(summary["seed"], 42);
  EXPECT_EQ(summary["xi"].size(), 5u);
  EXPECT_NEAR(summary["friction_angle_deg"]["mean"], sum / 4141, 1e-9);
  EXPECT_NEAR(summary["friction_angle_deg"]["min"], lo, 1e-9);
  EXPECT_NEAR(summary["friction_angle_deg"]["max"], hi, 1e-9);
  EXPECT_LT(lo, hi);
}

// Tables have every random property behind the columns of friction; a picture shows the one that is named.
TEST(FieldVerb, OtherProperties) {
  const std::string properties = TALUS_SOURCE_DIR "/schemas/examples/good/case-properties.json";
  const test::TemporaryDirectory directory;
  const Outcome outcome = talus({"field", properties, "--realization", "1", "--json", "--out", directory / "a.csv"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string text = read_file(directory / "a.csv", std::size_t{1} << 20);
  EXPECT_TRUE(contains(text, "x_m,y_m,friction_angle_deg,tan_phi,cohesion_kPa,unit_weight_kN_m3,viscosity_Pa_s\n"));
  const json summary = json::parse(outcome.out);
  EXPECT_EQ(summary["unit_weight_kN_m3"]["min"], summary["unit_weight_kN_m3"]["max"]);
  EXPECT_LT(summary["cohesion_kPa"]["min"], summary["cohesion_kPa"]["max"]);
  for (const char* name : {"cohesion", "unit_weight", "viscosity"}) {
    const std::string file = directory / (std::string(name) + ".svg");
    ASSERT_EQ(talus({"field", properties, "--realization", "1", "--property", name, "--out", file}).code, 0) << name;
    EXPECT_TRUE(contains(read_file(file, std::size_t{4} << 20), name == std::string("cohesion") ? "Cohesion" : "mean"));
  }
  const Outcome none = talus({"field", case_file, "--property", "cohesion", "--out", directory / "b.svg"});
  EXPECT_EQ(none.code, 3);
  EXPECT_TRUE(contains(none.err, "does not draw cohesion")) << none.err;
  EXPECT_FALSE(std::filesystem::exists(directory / "b.svg"));
  EXPECT_EQ(talus({"field", case_file, "--property", "colour", "--out", directory / "b.svg"}).code, 2);
}

// Median and spread of every random property in tables, of the one that is named in a picture.
TEST(FieldVerb, SpreadOfAProperty) {
  const std::string with_log = TALUS_SOURCE_DIR "/schemas/examples/good/case-property-data.json";
  const test::TemporaryDirectory directory;
  ASSERT_EQ(talus({"field", with_log, "--spread", "--out", directory / "a.csv"}).code, 0);
  const std::string text = read_file(directory / "a.csv", std::size_t{1} << 20);
  EXPECT_TRUE(contains(text,
                       "x_m,y_m,friction_angle_deg,tan_phi,cohesion_kPa,median_friction_angle_deg,"
                       "stdev_friction_angle_deg,median_cohesion_kPa,stdev_cohesion_kPa\n"));
  const std::string file = directory / "a.svg";
  ASSERT_EQ(talus({"field", with_log, "--spread", "--property", "cohesion", "--realization", "1", "--out", file}).code,
            0);
  const std::string picture = read_file(file, std::size_t{16} << 20);
  for (const char* part : {"Median, given the data", "standard deviation (kPa)", "8.5 kPa ± 1.0", "6.0 kPa ± 0.5"})
    EXPECT_TRUE(contains(picture, part)) << part;
}

// ln tan(phi) = mu + sigma Z is linear in xi: the fields of xi and -xi lie symmetrically about mu.
TEST(FieldVerb, GivenCoefficientsMakeTheField) {
  const test::TemporaryDirectory directory;
  write_file_atomically(directory / "xi.txt", "-1.9941\n-0.2451\n2.0280\n-1.3865\n-1.2416\n");
  write_file_atomically(directory / "minus.csv", "mode,xi\n1,1.9941\n2,0.2451\n3,-2.0280\n4,1.3865\n5,1.2416\n");
  const Outcome outcome =
      talus({"field", case_file, "--xi", directory / "xi.txt", "--json", "--out", directory / "a.csv"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(json::parse(outcome.out)["xi"], (json{-1.9941, -0.2451, 2.0280, -1.3865, -1.2416}));
  ASSERT_EQ(talus({"field", case_file, "--xi", directory / "minus.csv", "--out", directory / "b.csv"}).code, 0);
  const std::vector<Row> a = read_field(directory / "a.csv");
  const std::vector<Row> b = read_field(directory / "b.csv");
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_NEAR(std::log(a[i].tan_phi) + std::log(b[i].tan_phi), 2 * -0.7629, 1e-9);
    largest = std::max(largest, std::abs(std::log(a[i].tan_phi) + 0.7629));
  }
  EXPECT_GT(largest, 0.01);
}

TEST(FieldVerb, WithoutRealizationItIsTheMedian) {
  const Outcome outcome = talus({"field", case_file, "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json summary = json::parse(outcome.out);
  EXPECT_TRUE(summary["realization"].is_null());
  EXPECT_NEAR(summary["friction_angle_deg"]["min"], std::atan(std::exp(-0.7629)) * 180 / M_PI, 1e-9);
  EXPECT_NEAR(summary["friction_angle_deg"]["max"], std::atan(std::exp(-0.7629)) * 180 / M_PI, 1e-9);
}

TEST(FieldVerb, EveryEndingIsWritten) {
  const test::TemporaryDirectory directory;
  for (const std::string ending : {".csv", ".vtkhdf", ".svg", ".png"}) {
    const Outcome outcome =
        talus({"field", case_file, "--realization", "0", "--seed", "1", "--out", directory / ("a" + ending)});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.out, (directory / ("a" + ending)).string() + "\n");
    EXPECT_GT(std::filesystem::file_size(directory / ("a" + ending)), 1000u);
  }
}

TEST(FieldVerb, FaultsHaveTheirExitCodes) {
  const test::TemporaryDirectory directory;
  write_file_atomically(directory / "xi.txt", "1\ntwo\n");
  const std::string out = directory / "a.csv";
  Outcome outcome = talus({"field", case_file, "--xi", directory / "xi.txt", "--out", out});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_TRUE(contains(outcome.err, "xi.txt:2")) << outcome.err;
  write_file_atomically(directory / "xi.txt", "1\n2\n");
  outcome = talus({"field", case_file, "--xi", directory / "xi.txt", "--out", out});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_TRUE(contains(outcome.err, "2 coefficients, the field takes 5")) << outcome.err;
  EXPECT_EQ(talus({"field", case_file, "--xi", directory / "none.txt", "--out", out}).code, 5);
  EXPECT_EQ(talus({"field", case_file, "--set", "random_field.terms=0", "--out", out}).code, 3);
  EXPECT_EQ(talus({"field", case_file}).code, 2);
  EXPECT_EQ(talus({"field", case_file, "--out", directory / "a.jpg"}).code, 2);
  EXPECT_EQ(talus({"field", case_file, "--realization", "-1", "--out", out}).code, 2);
  EXPECT_EQ(talus({"field", case_file, "--realization", "1", "--xi", directory / "xi.txt", "--out", out}).code, 2);
  EXPECT_EQ(talus({"field", case_file, "--out", "/nonexistent/a.csv"}).code, 5);
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(FieldVerb, WithoutGnuplotThePictureFailsAndSaysWhy) {
  const test::TemporaryDirectory directory;
  const Outcome outcome = talus({"field", case_file, "--out", directory / "a.png"}, "PATH=/nonexistent");
  EXPECT_EQ(outcome.code, 5);
  EXPECT_TRUE(contains(outcome.err, "install gnuplot-nox")) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(directory / "a.png"));
  EXPECT_EQ(talus({"field", case_file, "--out", directory / "a.csv"}, "PATH=/nonexistent").code, 0);
}

TEST(PlotVerb, DrawsARunAndPrintsThePaths) {
  const test::TemporaryDirectory directory;
  const std::string dir = directory / "run";
  const Outcome run = talus({"run", TALUS_SOURCE_DIR "/solver/cases/dam-break.json", "--set", "particle_spacing_m=0.01",
                             "--set", "time.end_s=0.02", "--out", dir});
  ASSERT_EQ(run.code, 0) << run.err;
  const Outcome plot = talus({"plot", dir, "--json"});
  ASSERT_EQ(plot.code, 0) << plot.err;
  const json figures = json::parse(plot.out)["figures"];
  ASSERT_GE(figures.size(), 6u);
  for (const json& figure : figures) EXPECT_TRUE(std::filesystem::exists(figure.get<std::string>())) << figure;
  std::istringstream lines(talus({"plot", dir}).out);
  std::size_t n = 0;
  for (std::string line; std::getline(lines, line); ++n) EXPECT_EQ(line, figures[n].get<std::string>());
  EXPECT_EQ(n, figures.size());
}

TEST(PlotVerb, RefusesWhatIsNoStudyAndNoRun) {
  const test::TemporaryDirectory directory;
  const Outcome outcome = talus({"plot", directory.path().string()});
  EXPECT_EQ(outcome.code, 5);
  EXPECT_TRUE(contains(outcome.err, "neither study.json nor result.json")) << outcome.err;
  EXPECT_EQ(talus({"plot"}).code, 2);
}

}  // namespace
}  // namespace talus
