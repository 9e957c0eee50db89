#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "support/error.hpp"
#include "support/json.hpp"
#include "temporary_directory.hpp"

namespace talus {
namespace {

/// All faults of a text as "pointer: message" lines; "" when it parses.
std::string complaint(const std::string& text, const JsonLimits& limits = {}) {
  try {
    parse_json(text, "c.json", limits);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

TEST(ParseJson, KeepsOrderAndExactNumbers) {
  const Json document = parse_json(R"({"b": 0.1, "a": [1, -2.5e-3, 18446744073709551615]})", "c.json");
  EXPECT_EQ(document.dump(), R"({"b":0.1,"a":[1,-0.0025,18446744073709551615]})");
}

TEST(ParseJson, NamesLineAndColumnOfASyntaxError) {
  EXPECT_TRUE(complaint("{\n  \"a\": 1,\n  \"b\" 2\n}").starts_with("c.json:3:7: syntax error"))
      << complaint("{\n  \"a\": 1,\n  \"b\" 2\n}");
  EXPECT_TRUE(complaint("").starts_with("c.json:1:1: "));
  EXPECT_NE(complaint("{\"a\": 1").find("unexpected end of input"), std::string::npos);
  EXPECT_TRUE(complaint("{\"a\": \"\xff\"}").starts_with("c.json:1:"));
}

TEST(ParseJson, SaysWhatATextIsNot) {
  EXPECT_EQ(complaint(" x,y\n0,1\n"), "c.json: is not JSON: it begins with \"x,y\"; an object { ... } is expected");
  EXPECT_EQ(complaint("0,1\n"), "c.json: is not JSON: it begins with \"0,1\"; an object { ... } is expected");
  try {
    parse_json("x,y\n0,1\n", "bed.csv");
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find("with this CSV file as the value of a key"), std::string::npos) << e.what();
  }
}

TEST(ParseJson, RefusesWhatJsonDoesNotHave) {
  EXPECT_NE(complaint("{\"a\": NaN}").find("every number must be finite"), std::string::npos);
  EXPECT_NE(complaint("{\"a\": -Infinity}").find("every number must be finite"), std::string::npos);
  EXPECT_NE(complaint("{} // remark"), "");
  EXPECT_NE(complaint("{\"a\": 1,}"), "");
  EXPECT_EQ(complaint("{\"a\": [0, {\"b\": 1e400}]}"), "/a/1/b: is too large for a number");
  EXPECT_EQ(complaint("[0, 1e400]"), "/1: is too large for a number");
}

TEST(ParseJson, NamesEveryDoubleKey) {
  EXPECT_EQ(complaint(R"({"a": {"x": 1, "x": 2}, "b": [{}, {"y": 1, "z": 1, "y": 1}]})"),
            "/a/x: appears twice\n/b/1/y: appears twice");
  EXPECT_EQ(complaint(R"({"a": {"x": 1}, "b": {"x": 2}})"), "");
  EXPECT_EQ(complaint(R"({"a/b": 1, "a/b": 1})"), "/a~1b: appears twice");
}

TEST(ParseJson, HoldsItsLimits) {
  EXPECT_EQ(complaint(std::string(64, '[') + std::string(64, ']')), "");
  EXPECT_EQ(complaint(std::string(65, '[') + std::string(65, ']')), "the document is nested deeper than 64 levels");
  EXPECT_NE(complaint(std::string(10'000'000, '[')), "");
  EXPECT_EQ(complaint("[1,2,3]", {.bytes = 6}), "c.json: is larger than 0 MiB");
  EXPECT_EQ(complaint("[1,2,3]", {.values = 3}), "the document holds more than 3 values");
  EXPECT_EQ(complaint("[1,2,3]", {.values = 4}), "");
  EXPECT_EQ(complaint(R"({"a": "abcd"})", {.string = 3}), "/a: a string is longer than 3 bytes");
  EXPECT_EQ(complaint(R"({"a": 1, "b": 1, "c": 1})", {.members = 2}), "/c: one object holds more than 2 keys");
}

/// "[{},{},...]"
std::string empty_objects(std::size_t count) {
  std::string text = "[{}";
  for (std::size_t i = 1; i < count; ++i) text += ",{}";
  return text + "]";
}

// A parser that walks the open containers at each end of an object takes hours for this.
TEST(ParseJson, TakesManyObjectsUpToItsLimit) {
  EXPECT_EQ(parse_json(empty_objects(499'999), "c.json").size(), 499'999);
  EXPECT_EQ(complaint(empty_objects(500'000)), "the document holds more than 500000 values");
  EXPECT_EQ(complaint(empty_objects(5'000'000)), "the document holds more than 500000 values");
}

TEST(ReadText, RefusesWhatIsNoFile) {
  EXPECT_THROW(read_text("/nonexistent/case.json"), IoError);
  EXPECT_THROW(read_text("/"), IoError);
  EXPECT_THROW(read_text("/dev/zero"), IoError);
}

TEST(ReadText, RefusesHugeFiles) {
  const auto path = std::filesystem::temp_directory_path() / ("talus-huge-" + std::to_string(getpid()) + ".json");
  std::ofstream(path).put('{');
  std::filesystem::resize_file(path, (std::size_t{16} << 20) + 1);  // sparse
  EXPECT_THROW(read_text(path), ConfigError);
  std::filesystem::remove(path);
}

TEST(Checksum, TellsADamagedFileFromAWholeOne) {
  const Json document = {{"zone", 24.29}, {"text", "a \"checksum\": b"}, {"list", {1, 2}}};
  const std::string whole = with_checksum(document);
  EXPECT_TRUE(whole.starts_with("{\n  \"zone\": 24.29,\n"));
  const test::TemporaryDirectory directory;
  const auto read = [&](const std::string& text) {
    std::ofstream(directory / "a.json", std::ios::binary) << text;
    Json found = read_json(directory / "a.json", 1 << 16);
    found.erase("checksum");
    return found;
  };
  EXPECT_EQ(read(whole), document);
  EXPECT_EQ(read(document.dump(2) + "\n"), document);  // of an earlier version
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    std::string damaged = whole;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << (bit % 8)));
    try {
      Json found = read(damaged);
      if (found.size() > document.size()) found.erase(std::prev(found.end()));  // a damaged key "checksum"
      EXPECT_EQ(found, document) << damaged;
    } catch (const IoError&) {
    }
  }
  std::string other = whole;
  other.replace(other.find("24.29"), 5, "94.29");
  EXPECT_THROW(read(other), IoError);
}

}  // namespace
}  // namespace talus
