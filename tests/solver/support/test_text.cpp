#include <gtest/gtest.h>

#include <cstdlib>
#include <set>
#include <vector>

#include "support/seed.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

const std::vector<std::string> keys = {"cohesion_Pa", "friction_angle_deg", "viscosity_Pa_s"};

TEST(EditDistance, IsLevenshteins) {
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);  // the textbook example
  EXPECT_EQ(edit_distance("", "abc"), 3u);
  EXPECT_EQ(edit_distance("abc", ""), 3u);
  EXPECT_EQ(edit_distance("same", "same"), 0u);
  EXPECT_EQ(edit_distance("ab", "ba"), 2u);
}

TEST(NearestName, IsTheNearestOrNone) {
  EXPECT_EQ(nearest_name("friction_angle", keys), "friction_angle_deg");
  EXPECT_EQ(nearest_name("cohesion_kPa", keys), "cohesion_Pa");
  EXPECT_EQ(nearest_name("colour", keys), "");
  EXPECT_EQ(nearest_name(std::string(100'000, 'x'), keys), "");
}

TEST(Suggestion, NamesTheNearestElseAll) {
  EXPECT_EQ(suggestion("viscosity", keys), " (viscosity_Pa_s?)");
  EXPECT_EQ(suggestion("zzz", keys), "; known: cohesion_Pa, friction_angle_deg, viscosity_Pa_s");
}

TEST(Shorten, CutsBetweenCharactersAndHidesControls) {
  EXPECT_EQ(shorten("abcdef", 3), "abc...");
  EXPECT_EQ(shorten("abc", 3), "abc");
  EXPECT_EQ(shorten("a\xC3\xA4"
                    "b",
                    2),
            "a...");  // a-umlaut takes bytes 1 and 2: not cut in two
  EXPECT_EQ(shorten("a\nb\x1b[31m"), "a?b?[31m");
}

TEST(Numbers, AreWrittenShort) {
  EXPECT_EQ(to_text(0.1), "0.1");
  EXPECT_EQ(to_text(-0.0), "-0");
  EXPECT_EQ(to_text(1e300), "1e+300");
  EXPECT_EQ(to_text(34.0), "34");
  EXPECT_EQ(std::strtod(to_text(1.0 / 3.0).c_str(), nullptr), 1.0 / 3.0);
  EXPECT_EQ(rounded(1.0 / 3.0), "0.333");
}

TEST(Numbers, AreReadWhole) {
  EXPECT_EQ(to_number("-1.5e3"), -1500.0);
  EXPECT_EQ(to_number("+2"), 2.0);
  for (const char* text : {"", "+", "+-1", "1 ", " 1", "1x", "nan", "inf", "1e999", "0x10", "1,5"})
    EXPECT_EQ(to_number(text), std::nullopt) << text;
}

TEST(RandomSeed, IsExactInJsonAndNeverTheSame) {
  std::set<std::uint64_t> seeds;
  for (int i = 0; i < 1000; ++i) seeds.insert(random_seed());
  EXPECT_EQ(seeds.size(), 1000u);  // by chance with a probability of 1 - 6e-11
  EXPECT_LE(*seeds.rbegin(), static_cast<std::uint64_t>(max_exact_integer));
  EXPECT_GT(*seeds.rbegin(), std::uint64_t{1} << 40);
}

}  // namespace
}  // namespace talus
