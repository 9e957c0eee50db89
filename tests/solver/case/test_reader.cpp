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

constexpr KeyText nothing{"Meaning."};

std::string noted_number(const Json& value) {
  return noted({{"x", value}}, [](ObjectReader& in) {
    double x = 0.0;
    in.required_number("x", x, half_open, nothing);
  });
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
  double x = 3.0;
  std::optional<double> unset;
  EXPECT_EQ(noted(Json::object(), [&](ObjectReader& in) { in.required_number("x", x, half_open, nothing); }),
            "/m/x: is missing; unit Pa, allowed >= 0 and < 10");
  EXPECT_EQ(noted(Json::object(), [&](ObjectReader& in) { in.number("x", x, half_open, nothing); }), "");
  EXPECT_EQ(noted(Json::object(), [&](ObjectReader& in) { in.optional_number("x", unset, half_open, nothing); }), "");
  EXPECT_EQ(x, 3.0);
  EXPECT_FALSE(unset);
}

TEST(ObjectReader, WholeNumbersMayBeWrittenWithAPoint) {
  const auto read = [](const Json& value, int& n) {
    return noted({{"x", value}}, [&](ObjectReader& in) { in.integer("x", n, {"", 1, 9}, nothing); });
  };
  int n = 4;
  EXPECT_EQ(read(5, n), "");
  EXPECT_EQ(n, 5);
  EXPECT_EQ(read(6.0, n), "");
  EXPECT_EQ(n, 6);
  EXPECT_EQ(read(5.5, n), "/m/x: 5.5 is not a whole number; allowed >= 1 and <= 9");
}

TEST(ObjectReader, ChoicesFlagsAndTexts) {
  const auto colour = [](const Json& document, Colour c) {
    const std::string faults = noted(document, [&](ObjectReader& in) { in.choice("c", c, colours, nothing); });
    return faults.empty() ? (c == Colour::red ? "red" : "blue") : faults;
  };
  EXPECT_EQ(colour({{"c", "blue"}}, Colour::red), "blue");
  EXPECT_EQ(colour(Json::object(), Colour::blue), "blue");
  EXPECT_EQ(colour({{"c", "bleu"}}, Colour::red), "/m/c: \"bleu\" is not one of red, blue (blue?)");
  EXPECT_EQ(colour({{"c", 1}}, Colour::red), "/m/c: 1 is not one of red, blue");
  bool on = false;
  EXPECT_EQ(noted({{"f", "yes"}}, [&](ObjectReader& in) { in.flag("f", on, nothing); }),
            "/m/f: \"yes\" is neither true nor false");
  const auto text = [](ObjectReader& in) {
    std::string word;  // too short for a default
    in.string("t", word, {1, 2}, nothing);
  };
  EXPECT_EQ(noted({{"t", "\xC3\xA4\xC3\xB6"}}, text), "") << "characters count, not bytes";
  EXPECT_EQ(noted({{"t", ""}}, text), "/m/t: \"\" is not a string of 1 to 2 characters");
  EXPECT_EQ(noted({{"t", "abc"}}, text), "/m/t: \"abc\" is not a string of 1 to 2 characters");
  EXPECT_EQ(noted(Json::object(), text), "/m/t: is missing; a string of 1 to 2 characters");
}

TEST(ObjectReader, ListsNameTheElement) {
  const auto list = [](const Json& value) {
    std::vector<double> l;
    return noted({{"l", value}}, [&](ObjectReader& in) { in.numbers("l", l, {"", 0, 1}, {2, 3}, nothing); });
  };
  EXPECT_EQ(list({0, 1, 0.5}), "");
  EXPECT_EQ(list({0, 2, "a"}),
            "/m/l/1: 2 is out of range; allowed >= 0 and <= 1\n/m/l/2: \"a\" is not a number; allowed >= 0 and <= 1");
  EXPECT_EQ(list({0, 0, 0, 0}), "/m/l: has 4 numbers, at most 3 are allowed");
  EXPECT_EQ(list(Json::array({0})), "/m/l: has 1 numbers, at least 2 are needed");
  EXPECT_EQ(list(0), "/m/l: 0 is not a list of numbers; each allowed >= 0 and <= 1");
}

TEST(ObjectReader, UnknownKeysGetTheNearestName) {
  const auto read = [](ObjectReader& in) {
    double c = 0.0;
    in.number("cohesion_Pa", c, half_open, nothing);
  };
  EXPECT_EQ(noted({{"cohesion", 1}, {"", 2}}, read),
            "/m/cohesion: is not a known key (cohesion_Pa?)\n/m/: is not a known key; known: cohesion_Pa");
  EXPECT_EQ(noted({{"max_velocity_ratio", 1}}, read),
            "/m/max_velocity_ratio: is not a known key "
            "(walls.max_velocity_ratio?)");
}

TEST(ObjectReader, AMissingObjectIsOneFault) {
  const auto nested = [](ObjectReader& in) {
    double x = 0.0;
    in.object("o", "An object.", Absent::fault, [&](ObjectReader& child) {
      child.required_number("x", x, half_open, nothing);
      child.object("deeper", "Another.", Absent::fault,
                   [&](ObjectReader& deeper) { deeper.required_number("y", x, half_open, nothing); });
    });
  };
  EXPECT_EQ(noted(Json::object(), nested), "/m/o: is missing; an object");
  EXPECT_EQ(noted({{"o", 5}}, nested), "/m/o: 5 is not an object");
  EXPECT_EQ(noted({{"o", Json(std::vector<int>(101))}}, nested), "/m/o: an array of 101 values is not an object");
}

TEST(ObjectReader, AnOptionalObjectIsReadOnlyWhenGiven) {
  int reads = 0;
  const auto read = [&](ObjectReader& in) {
    in.object("o", "An object.", Absent::skip, [&](ObjectReader&) { ++reads; });
  };
  EXPECT_EQ(noted(Json::object(), read), "");
  EXPECT_EQ(reads, 0);
  EXPECT_EQ(noted({{"o", Json::object()}}, read), "");
  EXPECT_EQ(reads, 1);
}

TEST(ObjectReader, TwoKeysExcludeEachOther) {
  const auto read = [](ObjectReader& in) { in.exclude("a", "b"); };
  EXPECT_EQ(noted({{"a", 1}}, read), "");
  EXPECT_EQ(noted({{"a", 1}, {"b", 1}}, read), "/m/a: is given beside b; give one of the two");
}

TEST(ObjectReader, RecordsWhatIsInForce) {
  Faults faults;
  const Json document = {{"b", 2}, {"n", -0.0}};
  ObjectReader in(document, "", faults);
  double a = 1.0, b = 0.0, n = 1.0;
  std::optional<double> c;
  in.number("a", a, half_open, nothing);
  in.required_number("b", b, half_open, nothing);
  in.number("n", n, half_open, nothing);
  in.optional_number("c", c, half_open, nothing);
  EXPECT_EQ(in.finish().dump(), R"({"a":1.0,"b":2.0,"n":0.0})") << "2 and 2.0, 0 and -0 are one case";
}

/// The schema is that of the declarations.
TEST(ObjectReader, DescribesWhatItReads) {
  Faults none;
  ObjectReader in = ObjectReader::describing(none);
  double a = 1.0;
  std::optional<double> b;
  in.number("a", a, half_open, {"First.", "laboratory"});
  in.optional_number("b", b, half_open, {"Second.", "laboratory", "derived from a"});
  in.object("o", "An object.", Absent::fault, [&](ObjectReader& child) {
    std::string name;
    child.string("name", name, {1, 9}, {"A name."});
  });
  EXPECT_EQ(nlohmann::json(in.take_schema()), nlohmann::json::parse(R"({
    "type": "object", "additionalProperties": false,
    "properties": {
      "a": {"description": "First. Unit: Pa; range: >= 0 and < 10; default: 1.0; source: laboratory.",
            "type": "number", "minimum": 0, "exclusiveMaximum": 10, "default": 1.0},
      "b": {"description": "Second. Unit: Pa; range: >= 0 and < 10; default: derived from a; source: laboratory.",
            "type": "number", "minimum": 0, "exclusiveMaximum": 10},
      "o": {"description": "An object.", "type": "object", "additionalProperties": false,
            "properties": {"name": {"description": "A name. 1 to 9 characters; required; source: user.",
                                    "type": "string", "minLength": 1, "maxLength": 9}},
            "required": ["name"]}},
    "required": ["o"]})"));
  EXPECT_TRUE(none.empty());
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
