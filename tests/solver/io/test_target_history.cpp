#include <gtest/gtest.h>

#include "io/target_history.hpp"
#include "support/error.hpp"
#include "support/files.hpp"
#include "temporary_directory.hpp"

namespace talus {
namespace {

const std::vector<Target> targets{
    {.of = {"road \"A\"", TargetKind::stretch}},
    {.of = {"house", TargetKind::structure}, .structure = Structure{.boundary = 1, .foot = {}, .averaging = 0.1}}};

std::vector<TargetRow> rows() {
  return {{0.0, 0, 0, {0.1, 1.0 / 3.0, 5}, {}},
          {0.0, 0, 1, {0, 0, 0}, {}},
          {0.5, 9, 0, {0.2, 2, 7}, {}},
          {0.5, 9, 1, {1, 2, 3}, {{100, -20}, 1.0 / 3.0}}};
}

TEST(TargetHistory, ComesBackBitForBit) {
  const test::TemporaryDirectory directory;
  const auto path = directory / "targets.csv";
  write_target_history(path, targets, rows());
  const std::vector<TargetRow> back = read_target_history(path, targets);
  ASSERT_EQ(back.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(back[k].time, rows()[k].time);
    EXPECT_EQ(back[k].step, rows()[k].step);
    EXPECT_EQ(back[k].target, rows()[k].target);
    EXPECT_EQ(back[k].flow.depth, rows()[k].flow.depth);
    EXPECT_EQ(back[k].flow.speed, rows()[k].flow.speed);
    EXPECT_EQ(back[k].flow.dynamic_pressure, rows()[k].flow.dynamic_pressure);
    EXPECT_EQ(back[k].impulse, rows()[k].impulse);
  }
}

TEST(TargetHistory, StatesTheMeanLoadSinceTheRowBefore) {
  const test::TemporaryDirectory directory;
  const auto path = directory / "targets.csv";
  write_target_history(path, targets, rows());
  const std::string text = read_file(path, 10'000);
  EXPECT_NE(text.find("0.5,9,\"house\",1,2,3,200,-40,0.6666666666666666,100,-20,0.3333333333333333\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find(",7,,,,,,\n"), std::string::npos) << "a stretch has no load";
}

TEST(TargetHistory, RefusesWhatIsNotOne) {
  const test::TemporaryDirectory directory;
  const auto path = directory / "targets.csv";
  write_target_history(path, targets, rows());
  std::string text = read_file(path, 10'000);
  for (const auto& [from, to] : {std::pair{"time_s", "t"}, {"\"house\"", "\"barn\""}, {"0.5,9", "0.5,x"}}) {
    std::string bad = text;
    bad.replace(bad.find(from), std::string(from).size(), to);
    write_file_atomically(path, bad);
    EXPECT_THROW(read_target_history(path, targets), IoError) << from;
  }
}

}  // namespace
}  // namespace talus
