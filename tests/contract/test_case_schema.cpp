// The published schema is the one that the reader's declarations give, and it describes every key.

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <set>
#include <string>

#include "case/load.hpp"
#include "case/schema.hpp"
#include "schema_check.hpp"

namespace talus {
namespace {

using nlohmann::json;

/// Calls f(pointer, key schema, required) for every key of every object, arrays of objects by their element 0.
void for_each_key(const json& schema, const std::string& pointer,
                  const std::function<void(const std::string&, const json&, bool)>& f) {
  const json required = schema.value("required", json::array());
  for (const auto& [key, child] : schema.at("properties").items()) {
    const std::string here = pointer + "/" + key;
    f(here, child, std::find(required.begin(), required.end(), key) != required.end());
    if (child.contains("properties")) for_each_key(child, here, f);
    if (child.contains("items") && child["items"].contains("properties")) for_each_key(child["items"], here + "/0", f);
  }
}

TEST(CaseSchema, IsTheOneThatTheReaderDeclares) {
  const std::string published = test::slurp(test::source("schemas/case.schema.json"));
  EXPECT_TRUE(published == case_schema().dump(2) + "\n") << "out of date: talus schema case > schemas/case.schema.json";
}

TEST(CaseSchema, DescribesEveryKey) {
  const test::SchemaCheck schema("case");
  std::size_t keys = 0;
  for_each_key(schema.document(), "", [&](const std::string& pointer, const json& key, bool) {
    ++keys;
    const std::string description = key.value("description", "");
    EXPECT_GE(description.size(), 20u) << pointer;
    if (key["type"] != "number" && key["type"] != "integer") return;
    for (const char* word : {"Unit: ", "range: ", "source: "})
      EXPECT_NE(description.find(word), std::string::npos) << pointer << " " << word;
    EXPECT_TRUE(description.find("default: ") != std::string::npos || description.find("required") != std::string::npos)
        << pointer;
  });
  EXPECT_GT(keys, 90u);
}

TEST(CaseSchema, ClosesEveryObject) {
  const test::SchemaCheck schema("case");
  EXPECT_EQ(schema.document()["additionalProperties"], false);
  for_each_key(schema.document(), "", [](const std::string& pointer, const json& key, bool) {
    EXPECT_TRUE(!key.contains("properties") || key.value("additionalProperties", true) == false) << pointer;
  });
}

/// The unit in a number's key is the unit in its description.
TEST(CaseSchema, UnitsStandInTheKeys) {
  const test::SchemaCheck schema("case");
  const std::pair<const char*, const char*> suffixes[] = {{"_deg_per_m", "deg/m"},
                                                          {"_kPa_per_m", "kPa/m"},
                                                          {"_kg_m3", "kg/m3"},
                                                          {"_m_s2", "m/s2"},
                                                          {"_m_s", "m/s"},
                                                          {"_Pa_s", "Pa s"},
                                                          {"_Pa", "Pa"},
                                                          {"_deg", "deg"},
                                                          {"_1_s", "1/s"},
                                                          {"_mm", "mm"},
                                                          {"_kN_m3", "kN/m3"},
                                                          {"_kPa", "kPa"},
                                                          {"_spacings", "spacings"},
                                                          {"_m", "m"},
                                                          {"_s", "s"},
                                                          {"", "-"}};
  for_each_key(schema.document(), "", [&](const std::string& pointer, const json& key, bool) {
    if (key["type"] != "number") return;
    for (const auto& [suffix, unit] : suffixes)
      if (pointer.ends_with(suffix)) {
        EXPECT_NE(key["description"].get<std::string>().find(std::string("Unit: ") + unit + ";"), std::string::npos)
            << pointer;
        break;
      }
  });
}

TEST(CaseSchema, DefaultsAreTheReaders) {
  const test::SchemaCheck schema("case");
  auto document = nlohmann::ordered_json::parse(test::slurp(test::source("schemas/examples/good/case-minimal.json")));
  document["random_field"] = {{"correlation_length_m", 1}, {"log_stdev", 0.1}};
  const json plain = json::parse(load_case(document, "").resolved.dump());
  document["time"]["stop_at_rest"] = true;
  document["material"]["mu_i"] = {{"high_rate_friction_angle_deg", 40}, {"grain_diameter_m", 0.002}};
  document["slide"]["outlines"][0]["material"]["mu_i"] = document["material"]["mu_i"];
  document["water"] = {{"phreatic_line_m", {{-1e4, -1e3}, {1e4, -1e3}}}};
  const json switched_on = json::parse(load_case(document, "").resolved.dump());
  document["particle_lattice"] = {{"angle_deg", 30}};
  const json turned = json::parse(load_case(document, "").resolved.dump());
  document["particle_lattice"] = {{"shift_x_spacings", 0.25}};
  const json shifted = json::parse(load_case(document, "").resolved.dump());
  document["random_field"] = {{"correlation_length_m", 1}};
  for (const char* property : {"friction", "cohesion", "unit_weight", "viscosity"})
    document["random_field"]["properties"][property] = {{"cov", 0.1}};
  document["material"] = {
      {"density_kg_m3", 1900}, {"friction_angle_deg", 30}, {"cohesion_Pa", 5}, {"viscosity_Pa_s", 5}};
  document["slide"]["outlines"][0].erase("material");
  const json properties = json::parse(load_case(document, "").resolved.dump());
  std::size_t defaults = 0;
  for_each_key(schema.document(), "", [&](const std::string& pointer, const json& key, bool) {
    const json& lattice = pointer.ends_with("shift_x_spacings") ? turned : shifted;
    const json& of_section = pointer.starts_with("/particle_lattice")          ? lattice
                             : pointer.starts_with("/random_field/properties") ? properties
                                                                               : switched_on;
    const json& resolved = plain.contains(json::json_pointer(pointer)) ? plain : of_section;
    if (!key.contains("default")) return;
    ++defaults;
    const json::json_pointer at(pointer);
    ASSERT_TRUE(resolved.contains(at)) << pointer;
    EXPECT_EQ(resolved[at], key["default"]) << pointer;
    const std::string description = key["description"];
    const json& standard = key["default"];
    const std::string shown = standard.is_string() ? standard.get<std::string>() : standard.dump();
    EXPECT_NE(description.find("efault: " + (shown.empty() ? "empty" : shown)), std::string::npos)
        << pointer << " says another default";
  });
  EXPECT_GT(defaults, 45u);
}

/// Nothing is filled in silently: a key of the resolved case was given, or has a default in the schema, or is derived
/// and says so.
TEST(CaseSchema, SaysWhatTheReaderFillsIn) {
  const std::set<std::string> derived{"/terrain/slides_to",  "/terrain/measured_from_m", "/terrain/left_end",
                                      "/terrain/right_end",  "/terrain/wall_top_m",      "/terrain/front_thickness_m",
                                      "/numerics/integrator"};
  const test::SchemaCheck schema("case");
  const auto given = json::parse(test::slurp(test::source("schemas/examples/good/case-minimal.json")));
  const json resolved = json::parse(load_case(test::source("schemas/examples/good/case-minimal.json")).resolved.dump());
  for_each_key(schema.document(), "", [&](const std::string& pointer, const json& key, bool) {
    const json::json_pointer at(pointer);
    if (!resolved.contains(at) || given.contains(at) || key.contains("default") || key.contains("properties")) return;
    EXPECT_TRUE(derived.contains(pointer)) << pointer;
  });
}

}  // namespace
}  // namespace talus
