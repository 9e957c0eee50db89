#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "support/json.hpp"
#include "support/measures.hpp"

namespace talus {
namespace {

using Keys = std::vector<std::string>;

Keys keys_of_the_table() {
  Keys keys;
  for (const Measure& measure : measure_table) keys.emplace_back(measure.key);
  return keys;
}

Json schema(const std::string& name) { return read_json(TALUS_SOURCE_DIR "/schemas/" + name, std::size_t{1} << 24); }

/// Those of them that every document has had from version 0.1.0 on.
Keys keys_of_the_first_version() {
  Keys keys;
  for (const Measure& measure : measure_table)
    if (!measure.later) keys.emplace_back(measure.key);
  return keys;
}

/// Every list under the key `name` that begins with the first measure.
void collect(const Json& node, const std::string& name, std::vector<Keys>& lists) {
  if (node.is_object())
    for (const auto& [key, value] : node.items()) {
      if (key == name && value.is_array() && !value.empty() && value[0] == measure_table[0].key)
        lists.push_back(value.get<Keys>());
      collect(value, name, lists);
    }
  if (node.is_array())
    for (const Json& value : node) collect(value, name, lists);
}

TEST(MeasureTable, HasOneLineForEachMember) {
  EXPECT_EQ(measure_table.size() * sizeof(double), sizeof(Measures));
  std::set<std::string> keys;
  Measures all;
  for (const Measure& measure : measure_table) {
    EXPECT_TRUE(keys.insert(measure.key).second) << measure.key;
    EXPECT_EQ(all.*measure.member, 0.0) << measure.key << " shares its member with another measure";
    all.*measure.member = 1.0;
    EXPECT_TRUE(std::string(measure.key).ends_with(std::string("_") + measure.unit)) << measure.key;
    EXPECT_EQ(find_measure(measure.key), &measure);
  }
  EXPECT_EQ(find_measure("influence_zone"), nullptr);
}

TEST(MeasureTable, IsWhatTheSchemasSay) {
  const Json result = schema("result.schema.json");
  const auto required = result.at("required").get<Keys>();
  for (const std::string& key : keys_of_the_table()) {
    EXPECT_TRUE(result.at("properties").contains(key)) << key;
    EXPECT_EQ(std::ranges::count(required, key), std::ranges::count(keys_of_the_first_version(), key)) << key;
  }
  for (const char* name :
       {"result.schema.json", "study.schema.json", "processes/influence-zone.json", "openapi.json"}) {
    std::vector<Keys> enums, required_lists;
    collect(schema(name), "enum", enums);
    collect(schema(name), "required", required_lists);
    EXPECT_FALSE(enums.empty() && required_lists.empty()) << name;
    for (const Keys& list : enums) EXPECT_EQ(list, keys_of_the_table()) << name;
    for (const Keys& list : required_lists) {
      const Keys measures(list.begin(), list.begin() + std::min(list.size(), keys_of_the_first_version().size()));
      EXPECT_EQ(measures, keys_of_the_first_version()) << name;
    }
  }
}

TEST(MeasureTable, IsReadWithTheLeadingMeasureFirst) {
  const auto order = reading_order();
  EXPECT_EQ(order[0], &leading_measure);
  EXPECT_STREQ(order[1]->key, "influence_zone_m") << "the paper's beside it";
  EXPECT_EQ(std::set(order.begin(), order.end()).size(), measure_table.size()) << "each once";
}

}  // namespace
}  // namespace talus
