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

/// Every list under a key "enum" or "required" that names the first measure.
void collect(const Json& node, std::vector<Keys>& lists) {
  if (node.is_object())
    for (const auto& [key, value] : node.items()) {
      if ((key == "enum" || key == "required") && value.is_array() && !value.empty() &&
          value[0] == measure_table[0].key)
        lists.push_back(value.get<Keys>());
      collect(value, lists);
    }
  if (node.is_array())
    for (const Json& value : node) collect(value, lists);
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
    EXPECT_NE(std::find(required.begin(), required.end(), key), required.end()) << key;
  }
  for (const char* name : {"study.schema.json", "processes/influence-zone.json", "openapi.json"}) {
    std::vector<Keys> lists;
    collect(schema(name), lists);
    EXPECT_FALSE(lists.empty()) << name;
    for (const Keys& list : lists) EXPECT_EQ(list, keys_of_the_table()) << name;
  }
}

}  // namespace
}  // namespace talus
