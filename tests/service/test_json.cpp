#include <gtest/gtest.h>

#include "base/json.hpp"

namespace talus::service {
namespace {

/// The detail of the refusal and its first fault; "" when the body is accepted.
std::string why(const std::string& text) {
  try {
    parse_body(text);
  } catch (const Refusal& e) {
    EXPECT_EQ(e.reason, reason::bad_request);
    return e.what() + std::string(" | ") + e.faults.at(0).pointer + " " + e.faults.at(0).message;
  }
  return {};
}

// The limits themselves are those of every document: tests/solver/support/test_json.cpp.
TEST(RequestJson, HoldsTheLimitsOfEveryDocument) {
  EXPECT_EQ(why(std::string(65, '[')), "the body is refused |  the document is nested deeper than 64 levels");
  EXPECT_EQ(why(R"({"a": ")" + std::string(65'536, 'x') + "\"}"), "");
  EXPECT_EQ(why(R"({"a": ")" + std::string(65'537, 'x') + "\"}"),
            "the body is refused | /a a string is longer than 65536 bytes");
  EXPECT_EQ(why(R"({"a": 1, "b": {"a": 1}})"), "");
  EXPECT_EQ(why(R"({"a": 1, "a": 2})"), "the body is refused | /a appears twice");
}

TEST(RequestJson, WhatIsNotJson) {
  EXPECT_TRUE(why("").starts_with("the body is not JSON |  body:1:1: is empty")) << why("");
  EXPECT_TRUE(why("{\n \"a\" 2}").starts_with("the body is not JSON |  body:2:6: syntax error")) << why("{\n \"a\" 2}");
  for (const char* text : {"{", "{]", "nul", "[1,]", "\"\xff\"", "NaN", "// x\n1", "{\"a\":1} x"})
    EXPECT_TRUE(why(text).starts_with("the body is not JSON | ")) << text;
}

}  // namespace
}  // namespace talus::service
