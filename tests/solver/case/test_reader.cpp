#include <gtest/gtest.h>

#include <limits>

#include "case/reader.hpp"

namespace talus {
namespace {

enum class Colour { red, blue };
constexpr Names<Colour> colours[] = {{"red", Colour::red}, {"blue", Colour::blue}};
constexpr Quantity half_open{"Pa", 0.0, 10.0, false, true};

/// Reads with `use`, closes, and returns what was noted.
template <class Use>
std::string noted(const Json& document, Use&& use) {
  Faults faults;
  ObjectReader in(document, "/m", faults);
  use(in);
  in.finish();
  return faults.empty() ? "" : ConfigError(faults.all()).what();
}

std::string noted_number(const Json& value) {
  return noted({{"x", value}}, [](ObjectReader& in) { in.number("x", half_open); });
}

TEST(ObjectReader, NumbersStayInTheirRange) {
  EXPECT_EQ(noted_number(0), "");
  EXPECT_EQ(noted_number(9.999), "");
  EXPECT_EQ(noted_number(10), "/m/x: 10 is out of range; unit Pa, allowed >= 0 and < 10");
  EXPECT_EQ(noted_number(-1e-300), "/m/x: -1e-300 is out of range; unit Pa, allowed >= 0 and < 10");
  EXPECT_EQ(noted_number("5 kPa"), "/m/x: \"5 kPa\" is not a number; unit Pa, allowed >= 0 and < 10");
  EXPECT_EQ(noted_number(true), "/m/x: true is not a number; unit Pa, allowed >= 0 and < 10");
  EXPECT_EQ(noted_number(std::numeric_limits<double>::quiet_NaN()),
            "/m/x: is not finite; unit Pa, allowed >= 0 and < 10");
  EXPECT_EQ(noted_number(std::numeric_limits<double>::infinity()),
            "/m/x: is not finite; unit Pa, allowed >= 0 and < 10");
}

TEST(ObjectReader, MissingIsAFaultOnlyWithoutADefault) {
  EXPECT_EQ(noted(Json::object(), [](ObjectReader& in) { in.number("x", half_open); }),
            "/m/x: is missing; unit Pa, allowed >= 0 and < 10");
  EXPECT_EQ(noted(Json::object(), [](ObjectReader& in) { EXPECT_EQ(in.number("x", half_open, 3.0), 3.0); }), "");
  EXPECT_EQ(noted(Json::object(), [](ObjectReader& in) { EXPECT_FALSE(in.maybe_number("x", half_open)); }), "");
}

TEST(ObjectReader, WholeNumbersMayBeWrittenWithAPoint) {
  const auto use = [](ObjectReader& in) { EXPECT_EQ(in.integer("x", {"", 1, 9}, 4), 5); };
  EXPECT_EQ(noted({{"x", 5}}, use), "");
  EXPECT_EQ(noted({{"x", 5.0}}, use), "");
  EXPECT_EQ(noted({{"x", 5.5}},
                  [](ObjectReader& in) {
                    in.integer("x", {"", 1, 9}, 4);
                  }),
            "/m/x: 5.5 is not a whole number; allowed >= 1 and <= 9");
}

TEST(ObjectReader, ChoicesFlagsAndTexts) {
  const auto colour = [](ObjectReader& in) { in.choice("c", colours, Colour::red); };
  EXPECT_EQ(
      noted({{"c", "blue"}}, [](ObjectReader& in) { EXPECT_EQ(in.choice("c", colours, Colour::red), Colour::blue); }),
      "");
  EXPECT_EQ(
      noted(Json::object(), [](ObjectReader& in) { EXPECT_EQ(in.choice("c", colours, Colour::blue), Colour::blue); }),
      "");
  EXPECT_EQ(noted({{"c", "bleu"}}, colour), "/m/c: \"bleu\" is not one of red, blue (blue?)");
  EXPECT_EQ(noted({{"c", 1}}, colour), "/m/c: 1 is not one of red, blue");
  EXPECT_EQ(noted({{"f", "yes"}}, [](ObjectReader& in) { in.flag("f", false); }),
            "/m/f: \"yes\" is neither true nor false");
  const auto text = [](ObjectReader& in) { in.text("t", 1, 2); };
  EXPECT_EQ(noted({{"t", "\xC3\xA4\xC3\xB6"}}, text), "") << "characters count, not bytes";
  EXPECT_EQ(noted({{"t", ""}}, text), "/m/t: \"\" is not a string of 1 to 2 characters");
  EXPECT_EQ(noted({{"t", "abc"}}, text), "/m/t: \"abc\" is not a string of 1 to 2 characters");
}

TEST(ObjectReader, ListsNameTheElement) {
  const auto list = [](ObjectReader& in) { in.numbers("l", {"", 0, 1}, 3); };
  EXPECT_EQ(noted({{"l", {0, 1, 0.5}}}, list), "");
  EXPECT_EQ(noted({{"l", {0, 2, "a"}}}, list),
            "/m/l/1: 2 is out of range; allowed >= 0 and <= 1\n/m/l/2: \"a\" is not a number; allowed >= 0 and <= 1");
  EXPECT_EQ(noted({{"l", {0, 0, 0, 0}}}, list), "/m/l: has 4 numbers, at most 3 are allowed");
  EXPECT_EQ(noted({{"l", 0}}, list), "/m/l: 0 is not a list of numbers; each allowed >= 0 and <= 1");
}

TEST(ObjectReader, UnknownKeysGetTheNearestName) {
  EXPECT_EQ(noted({{"cohesion", 1}, {"", 2}}, [](ObjectReader& in) { in.number("cohesion_Pa", half_open, 0.0); }),
            "/m/cohesion: is not a known key (cohesion_Pa?)\n/m/: is not a known key; known: cohesion_Pa");
}

TEST(ObjectReader, AMissingObjectIsOneFault) {
  const auto nested = [](ObjectReader& in) {
    ObjectReader child = in.object("o", true);
    child.number("x", half_open);
    child.object("deeper", true).number("y", half_open);
    child.finish();
  };
  EXPECT_EQ(noted(Json::object(), nested), "/m/o: is missing; an object");
  EXPECT_EQ(noted({{"o", 5}}, nested), "/m/o: 5 is not an object");
}

TEST(ObjectReader, RecordsWhatIsInForce) {
  Faults faults;
  const Json document = {{"b", 2}, {"n", -0.0}};
  ObjectReader in(document, "", faults);
  in.number("a", half_open, 1.0);
  in.number("b", half_open);
  in.number("n", half_open);
  in.maybe_number("c", half_open);
  EXPECT_EQ(in.finish().dump(), R"({"a":1.0,"b":2.0,"n":0.0})") << "2 and 2.0, 0 and -0 are one case";
}

TEST(Faults, AreCappedButCounted) {
  Faults faults;
  for (int k = 0; k < 150; ++k) faults.add("/x", "wrong");
  EXPECT_EQ(faults.size(), 150u);
  ASSERT_EQ(faults.all().size(), 101u);
  EXPECT_EQ(faults.all().back().message, "and 50 more faults");
}

TEST(Faults, LieUnderWholeTokensOnly) {
  Faults faults;
  faults.add("/time/end_s", "wrong");
  EXPECT_FALSE(faults.none_under("/time"));
  EXPECT_FALSE(faults.none_under("/time/end_s"));
  EXPECT_TRUE(faults.none_under("/tim"));
  EXPECT_TRUE(faults.none_under("/time/end_s/0"));
}

}  // namespace
}  // namespace talus
