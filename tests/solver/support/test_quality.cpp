#include <gtest/gtest.h>

#include "support/quality.hpp"

namespace talus {
namespace {

TEST(Quality, ReasonsComeBackFromTheirText) {
  Quality quality{.verdict = Verdict::doubtful};
  EXPECT_EQ(objections_text(quality), "");
  EXPECT_TRUE(objections_in("").empty());
  quality.reasons = {{.check = "left_terrain", .message = "3 of 5 left, at t = 2 s: gone"}};
  EXPECT_EQ(objections_text(quality), "left_terrain: 3 of 5 left, at t = 2 s: gone");
  quality.reasons.push_back({.check = "mach_number", .message = "1.5 times"});
  EXPECT_EQ(objections_in(objections_text(quality)),
            (std::vector<Objection>{{"left_terrain", "3 of 5 left, at t = 2 s: gone"}, {"mach_number", "1.5 times"}}));
  EXPECT_EQ(objections_in("no colon"), (std::vector<Objection>{{"no colon", ""}}));
}

TEST(Quality, EveryVerdictHasItsWord) {
  for (const Verdict verdict : {Verdict::not_assessed, Verdict::sound, Verdict::doubtful, Verdict::invalid})
    EXPECT_EQ(verdict_of(word(verdict)), verdict);
  EXPECT_STREQ(word(Verdict::doubtful), "doubtful");
  EXPECT_FALSE(verdict_of("good"));
  EXPECT_EQ(words_of_check("still_moving"), "still moving");
}

TEST(Quality, ALineForEachReasonTheWorstFirst) {
  const Quality quality{.verdict = Verdict::invalid,
                        .reasons = {{.check = "still_moving", .verdict = Verdict::doubtful, .message = "it moves"},
                                    {.check = "mach_number", .verdict = Verdict::invalid, .message = "too fast"}}};
  EXPECT_EQ(verdict_lines(quality), "invalid: too fast\ndoubtful: it moves\n");
  EXPECT_EQ(verdict_lines({.verdict = Verdict::sound}), "");
}

}  // namespace
}  // namespace talus
