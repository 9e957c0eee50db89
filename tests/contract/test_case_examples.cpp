// Every example through schema and reader: schemas/examples/good/case-*.json and solver/cases pass both;
// bad/case-schema-* are refused by both, bad/case-meaning-* by the reader alone (no schema can see a crossing outline),
// bad/case-syntax-* are no documents at all. Beside each bad one stand its faults, all of them, as the reader must word
// them.

#include <gtest/gtest.h>

#include "case/load.hpp"
#include "schema_check.hpp"

namespace talus {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> good_cases() {
  auto all = test::files("schemas/examples/good", "case-", ".json");
  const auto shipped = test::files("solver/cases", "", ".json");
  all.insert(all.end(), shipped.begin(), shipped.end());
  return all;
}

/// All faults, one a line, as in the .expected files.
std::string faults_of(const fs::path& path) {
  try {
    load_case(path);
  } catch (const ConfigError& e) {
    return std::string(e.what()) + "\n";
  }
  return "";
}

TEST(CaseExamples, GoodOnesPassBoth) {
  const test::SchemaCheck schema("case");
  ASSERT_GE(good_cases().size(), 4u + 15u);
  for (const fs::path& path : good_cases()) {
    EXPECT_EQ(schema.complaint(nlohmann::json::parse(test::slurp(path))), "") << path;
    EXPECT_EQ(faults_of(path), "") << path;
  }
}

TEST(CaseExamples, BadOnesEarnTheirFaults) {
  const auto all = test::files("schemas/examples/bad", "case-", ".json");
  ASSERT_GE(all.size(), 40u);
  for (const fs::path& path : all)
    EXPECT_EQ(faults_of(path), test::slurp(fs::path(path).replace_extension(".expected"))) << path;
}

TEST(CaseExamples, TheSchemaRefusesWhatItCanSee) {
  const test::SchemaCheck schema("case");
  for (const fs::path& path : test::files("schemas/examples/bad", "case-schema-", ".json"))
    EXPECT_NE(schema.complaint(nlohmann::json::parse(test::slurp(path))), "") << path;
  for (const fs::path& path : test::files("schemas/examples/bad", "case-meaning-", ".json"))
    EXPECT_EQ(schema.complaint(nlohmann::json::parse(test::slurp(path))), "") << path;
}

TEST(CaseExamples, TheResolvedCaseIsTheSameCase) {
  const test::SchemaCheck schema("case");
  for (const fs::path& path : good_cases()) {
    const LoadedCase first = load_case(path);
    const std::string text = first.resolved.dump(2);
    const LoadedCase second = load_case(nlohmann::ordered_json::parse(text), "/nonexistent");
    EXPECT_TRUE(second.value == first.value) << path;
    EXPECT_EQ(second.resolved.dump(2), text) << path;
    EXPECT_EQ(second.hash, first.hash) << path;
    EXPECT_EQ(schema.complaint(nlohmann::json::parse(text)), "") << path;
  }
}

}  // namespace
}  // namespace talus
