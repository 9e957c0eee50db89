#include <gtest/gtest.h>

#include "support/json.hpp"

namespace talus::service {
namespace {

std::string why(const std::string& text) {
  try {
    parse_json(text);
  } catch (const Refusal& e) {
    EXPECT_EQ(e.reason, Reason::bad_request);
    return e.what();
  }
  return {};
}

std::string nested(int depth) {
  return std::string(static_cast<std::size_t>(depth), '[') + std::string(static_cast<std::size_t>(depth), ']');
}
std::string text_of(std::size_t bytes) { return '"' + std::string(bytes, 'a') + '"'; }

TEST(RequestJson, NestingUpTo64) {
  EXPECT_EQ(why(nested(64)), "");
  EXPECT_EQ(why(nested(65)), "values are nested deeper than 64");
  EXPECT_EQ(why(nested(1'000'000)), "values are nested deeper than 64");
  EXPECT_EQ(why("[\"" + std::string(100, '[') + "\"]"), "");  // brackets in a string are no nesting
  EXPECT_EQ(why("[\"\\\"" + std::string(100, '[') + "\"]"), "");
}

TEST(RequestJson, StringsUpTo4Kilobytes) {
  EXPECT_EQ(why(text_of(4096)), "");
  EXPECT_EQ(why(text_of(4097)), "a string is longer than 4096 bytes");
  EXPECT_EQ(why("{" + text_of(4097) + ": 1}"), "a string is longer than 4096 bytes");
}

TEST(RequestJson, WhatIsNotJson) {
  EXPECT_EQ(why(""), "the body is empty; a JSON value is needed");
  for (const char* text : {"{", "{]", "nul", "[1,]", "\"\xff\"", "NaN", "1e999", "// x\n1", "{\"a\":1} x"})
    EXPECT_EQ(why(text), "the body is not JSON") << text;
  EXPECT_EQ(why("{\"a\": 1, \"b\": {\"a\": 1}}"), "");
  EXPECT_EQ(why("{\"a\": 1, \"a\": 2}"), "the key \"a\" stands twice in one object");
}

TEST(RequestJson, PointersAreEscaped) { EXPECT_EQ(pointer_token("a/b~c"), "/a~1b~0c"); }

}  // namespace
}  // namespace talus::service
