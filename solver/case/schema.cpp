#include "case/schema.hpp"

#include "case/sections.hpp"

namespace talus {
namespace {

void collect(const Json& schema, const std::string& prefix, std::vector<CaseKey>& keys) {
  for (const auto& [key, value] : schema.at("properties").items()) {
    const bool list = value.contains("items") && value["items"].contains("properties");
    if (value["type"] != "object" && !list)
      keys.push_back({prefix + key, value["description"], value.value("enum", std::vector<std::string>{})});
    if (value.contains("properties")) collect(value, prefix + key + ".", keys);
    if (list) collect(value["items"], prefix + key + ".0.", keys);
  }
}

}  // namespace

Json case_schema() {
  Faults none;
  ObjectReader root = ObjectReader::describing(none);
  SourceLocations origins;
  read_case(root, "", origins);
  Json schema = {
      {"$schema", "http://json-schema.org/draft-07/schema#"},
      {"$id", "urn:talus:case"},
      {"title", "Talus case"},
      {"description",
       "A landslide to be simulated: terrain, slide, soil, method, time, random field and study. SI units and "
       "degrees; each key ends with its unit; unknown keys are errors. [Z20]: Zhang et al., Geoscience "
       "Frontiers 11 (2020) 1107-1121."}};
  schema.update(root.take_schema());
  return schema;
}

std::vector<CaseKey> case_keys() {
  std::vector<CaseKey> keys;
  collect(case_schema(), "", keys);
  return keys;
}

std::string path_of_key(std::string_view name) {
  if (name.empty()) return "";
  for (const CaseKey& key : case_keys())
    if (key.path.ends_with("." + std::string(name))) return key.path;
  return "";
}

}  // namespace talus
