#include <gtest/gtest.h>

#include "example_study.hpp"
#include "figures/study_files.hpp"
#include "reading.hpp"
#include "support/error.hpp"
#include "support/files.hpp"
#include "temporary_directory.hpp"

namespace talus::figures {
namespace {

using test::contains;

std::string error_of(const std::filesystem::path& directory) {
  try {
    read_study(directory);
  } catch (const IoError& e) {
    return e.what();
  }
  return {};
}

TEST(StudyFiles, SayWhatTheStudyWrote) {
  const test::TemporaryDirectory directory;
  test::write_example_study(directory.path(), test::example_plan(12), test::example_records(12, true),
                            test::example_floor());
  const StudyFiles study = read_study(directory.path());
  EXPECT_EQ(study.title, "Example");
  EXPECT_TRUE(contains(study.source, "seed 42"));
  EXPECT_EQ(study.planned, 12);
  EXPECT_EQ(study.done, 11);
  EXPECT_EQ(study.failed, 1);
  ASSERT_EQ(study.realizations.size(), 11u);
  EXPECT_DOUBLE_EQ(study.realizations[7].influence_zone, 30.7);
  EXPECT_DOUBLE_EQ(study.realizations[7].mean_phi_deg, 24.3);
  const Quantity& q = study.quantities.at("influence_zone_m");
  EXPECT_DOUBLE_EQ(*q.mean, 30.5);
  // Standard deviation of 0..10 is sqrt(11).
  EXPECT_NEAR(*q.stdev, 0.1 * std::sqrt(11.0), 1e-12);
  EXPECT_DOUBLE_EQ(q.quantiles.at(0.5), 30.5);
  EXPECT_GT(*q.noise_floor_stdev, 0.0);
  EXPECT_EQ(study.quantities.size(), measure_table.size());
  // 1 of 12 failed: it stays in the denominator.
  EXPECT_EQ(q.exceedance.front().n, 12);
}

TEST(StudyFiles, AStudyOfOneHasNoIntervals) {
  const test::TemporaryDirectory directory;
  test::write_example_study(directory.path(), test::example_plan(1), test::example_records(1, false), {});
  const Quantity q = read_study(directory.path()).quantities.at("influence_zone_m");
  EXPECT_DOUBLE_EQ(*q.mean, 30.0);
  EXPECT_FALSE(q.mean_ci95);
  EXPECT_FALSE(q.noise_floor_stdev);
}

TEST(StudyFiles, FaultsNameTheFile) {
  const test::TemporaryDirectory directory;
  EXPECT_TRUE(contains(error_of(directory.path()), "study.json"));
  write_file_atomically(directory / "study.json", "{\"title\": ");
  EXPECT_TRUE(contains(error_of(directory.path()), "study.json"));
  write_file_atomically(directory / "study.json", "{\"title\": 3}");
  EXPECT_TRUE(contains(error_of(directory.path()), "study.json"));
  test::write_example_study(directory.path(), test::example_plan(3), test::example_records(3, false), {});
  const std::string table = read_file(directory / "realizations.csv", 10000);
  const std::string header = table.substr(0, table.find('\n') + 1);
  std::string row = table.substr(header.size(), table.find('\n', header.size()) + 1 - header.size());
  row.replace(row.find("done,") + 5, row.find(',', row.find("done,") + 5) - row.find("done,") - 5, "far");
  write_file_atomically(directory / "realizations.csv", header + row);
  EXPECT_TRUE(contains(error_of(directory.path()), "realizations.csv:2 does not agree with its checksum"));
  const auto without_checksum = [](const std::string& line) { return line.substr(0, line.rfind(',')) + "\n"; };
  write_file_atomically(directory / "realizations.csv", without_checksum(header) + without_checksum(row));
  EXPECT_TRUE(contains(error_of(directory.path()), "\"far\" is not a number"));
  write_file_atomically(directory / "realizations.csv", header + "0,done,1\n");
  EXPECT_TRUE(contains(error_of(directory.path()), "realizations.csv:2"));
}

}  // namespace
}  // namespace talus::figures
