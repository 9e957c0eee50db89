// Every key of the schema is spoilt in every way that its keywords name; schema and reader must both refuse, and the
// reader at the right place. At the end no key may have been left out.

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <set>

#include "case/load.hpp"
#include "schema_check.hpp"

namespace talus {
namespace {

using nlohmann::json;

class Mutations {
 public:
  /// Spoils all keys that `document` holds, one at a time.
  void spoil(const json& document) {
    base_ = document;
    object(schema_.document(), "", "");
  }
  const std::set<std::string>& visited() const { return visited_; }
  std::size_t count() const { return count_; }

 private:
  const json& value(const std::string& at) const { return base_[json::json_pointer(at)]; }

  /// The document with one value changed must be refused by both; the reader's fault lies at `place` or below it, or
  /// above.
  void expect_refused(const std::string& at, json changed, const std::string& place) {
    ++count_;
    json document = base_;
    document[json::json_pointer(at)] = std::move(changed);
    refuse(document, place);
  }
  void refuse(const json& document, const std::string& place) {
    const std::string shown =
        document.contains(json::json_pointer(place)) ? document[json::json_pointer(place)].dump().substr(0, 80) : "";
    EXPECT_NE(schema_.complaint(document), "") << place << " = " << shown;
    try {
      load_case(nlohmann::ordered_json(document), test::source("schemas/examples/good"));
      ADD_FAILURE() << "the reader takes " << place << " = " << shown;
    } catch (const ConfigError& e) {
      bool placed = false;
      for (const Fault& f : e.faults) placed = placed || f.pointer.starts_with(place);
      EXPECT_TRUE(placed) << place << " = " << shown << " but " << e.what();
    }
  }

  void object(const json& schema, const std::string& at, const std::string& schema_at) {
    if (!at.empty()) expect_refused(at, 5, at);
    if (!at.empty()) expect_refused(at, nullptr, at);
    expect_refused(at + "/no_such_key", 1, at + "/no_such_key");
    for (const json& key : schema.value("required", json::array())) {
      json document = base_;
      (at.empty() ? document : document[json::json_pointer(at)]).erase(key.get<std::string>());
      ++count_;
      refuse(document, at + "/" + key.get<std::string>());
    }
    for (const auto& [key, child] : schema.at("properties").items()) {
      const std::string here = at + "/" + key;
      if (base_.contains(json::json_pointer(here))) member(child, here, schema_at + "/" + key);
    }
  }

  void member(const json& schema, const std::string& at, const std::string& schema_at) {
    visited_.insert(schema_at);
    const json& type = schema.at("type");
    if (type == "object")
      object(schema, at, schema_at);
    else if (type.is_array())  // stop_at_rest: a flag or a rule
      value(at).is_object() ? object(schema, at, schema_at) : expect_refused(at, "yes", at);
    else if (type == "array")
      array(schema, at, schema_at);
    else if (type == "string")
      string(schema, at);
    else if (type == "boolean")
      for (const json& wrong : {json("yes"), json(1), json(nullptr)}) expect_refused(at, wrong, at);
    else
      number(schema, at);
  }

  void number(const json& schema, const std::string& at) {
    for (const json& wrong : {json("5 kPa"), json(true), json(nullptr), json::array({1}), json::object()})
      expect_refused(at, wrong, at);
    ASSERT_TRUE(schema.contains("minimum") != schema.contains("exclusiveMinimum")) << at;
    ASSERT_TRUE(schema.contains("maximum") != schema.contains("exclusiveMaximum")) << at;
    const auto below = [](double x) { return x == 0.0 ? -1e-9 : x - 1e-9 * std::abs(x); };
    const auto above = [](double x) { return x + 1e-9 * std::abs(x); };
    const bool whole = schema["type"] == "integer";
    if (schema.contains("minimum"))
      expect_refused(at, whole ? json(schema["minimum"].get<std::int64_t>() - 1) : json(below(schema["minimum"])), at);
    if (schema.contains("exclusiveMinimum")) expect_refused(at, schema["exclusiveMinimum"], at);
    if (schema.contains("maximum"))
      expect_refused(at, whole ? json(schema["maximum"].get<std::int64_t>() + 1) : json(above(schema["maximum"])), at);
    if (schema.contains("exclusiveMaximum")) expect_refused(at, schema["exclusiveMaximum"], at);
    if (whole) expect_refused(at, 1.5, at);
  }

  void string(const json& schema, const std::string& at) {
    for (const json& wrong : {json(5), json(nullptr), json::array()}) expect_refused(at, wrong, at);
    if (schema.contains("enum")) expect_refused(at, "no_such_choice", at);
    if (schema.contains("minLength"))
      expect_refused(at, std::string(schema["minLength"].get<std::size_t>() - 1, 'x'), at);
    if (schema.contains("maxLength"))
      expect_refused(at, std::string(schema["maxLength"].get<std::size_t>() + 1, 'x'), at);
    if (schema.contains("pattern"))
      for (const char* wrong : {"../x.csv", "/x.csv", "a/../b.csv", "a//b.csv", "a/", ".csv", "a\\b"})
        expect_refused(at, wrong, at);
  }

  void array(const json& schema, const std::string& at, const std::string& schema_at) {
    for (const json& wrong : {json(5), json("1, 2"), json(nullptr)}) expect_refused(at, wrong, at);
    const json element = value(at).empty() ? json(0) : value(at)[0];
    if (schema.contains("minItems") && schema["minItems"] != 0) {
      json few = json::array();
      for (std::size_t k = 0; k + 1 < schema["minItems"].get<std::size_t>(); ++k) few.push_back(value(at)[k]);
      expect_refused(at, few, at);
    }
    if (schema["maxItems"] < 100'000) expect_refused(at, json(schema["maxItems"].get<std::size_t>() + 1, element), at);
    const json& items = schema.at("items");
    for (std::size_t k = 0; k < value(at).size() && k < 2; ++k) {
      const std::string here = at + "/" + std::to_string(k);
      if (items.contains("properties"))
        object(items, here, schema_at + "/*");
      else if (items["type"] == "array")
        array(items, here, schema_at + "/*");
      else if (items["type"] == "string")
        string(items, here);
      else
        number(items, here);
    }
  }

  test::SchemaCheck schema_{"case"};
  json base_;
  std::set<std::string> visited_;
  std::size_t count_ = 0;
};

void collect(const json& schema, const std::string& at, std::set<std::string>& keys) {
  for (const auto& [key, child] : schema.at("properties").items()) {
    keys.insert(at + "/" + key);
    if (child.contains("properties")) collect(child, at + "/" + key, keys);
    if (child.contains("items") && child["items"].contains("properties"))
      collect(child["items"], at + "/" + key + "/*", keys);
  }
}

TEST(CaseMutations, SchemaAndReaderRefuseEveryOne) {
  const auto example = [](const char* name) {
    return json::parse(test::slurp(test::source(std::string("schemas/examples/good/case-") + name + ".json")));
  };
  Mutations mutations;
  mutations.spoil(example("full"));
  mutations.spoil(example("surfaces"));
  mutations.spoil(example("joined"));
  mutations.spoil(example("mu-i"));
  mutations.spoil(example("soil"));
  mutations.spoil(example("field"));
  mutations.spoil(example("field-data"));
  // The forms that the examples do not hold: the other file, the other step.
  json other = example("surfaces");
  other["slide"] = {{"ground_surface_m", {{0, 20}, {6, 20}, {24, 6}}}, {"slip_surface_csv", "case-bed.csv"}};
  mutations.spoil(other);
  other["slide"] = {{"outlines", {{{"outline_csv", "case-outline.csv"}}}}};
  mutations.spoil(other);
  other["material"] = {{"unit_weight_kN_m3", 19}, {"friction_angle_deg", 24}, {"cohesion_kPa", 5}};
  other["slide"]["outlines"][0]["material"] = {{"unit_weight_kN_m3", 18}, {"cohesion_kPa", 2}};
  mutations.spoil(other);
  for (json* material : {&other["material"], &other["slide"]["outlines"][0]["material"]}) {
    (*material)["mu_i"] = {{"high_rate_friction_angle_deg", 40}, {"grain_diameter_mm", 3}};
  }
  mutations.spoil(other);
  const json drained_softening = {{"residual_cohesion_Pa", 0}, {"displacement_m", 0.1}, {"band_width_m", 2}};
  other["material"] = {{"density_kg_m3", 1800},
                       {"undrained_strength_kPa", 20},
                       {"undrained_strength_gradient_kPa_per_m", 1},
                       {"softening", {{"residual_undrained_strength_kPa", 5}, {"plastic_shear_strain", 0.1}}}};
  other["slide"]["outlines"][0]["material"] = {{"friction_angle_deg", 20}, {"softening", drained_softening}};
  mutations.spoil(other);
  other["material"] = {{"density_kg_m3", 1800},
                       {"friction_angle_deg", 20},
                       {"cohesion_kPa", 2},
                       {"r_u", 0.1},
                       {"softening", drained_softening}};
  other["slide"]["outlines"][0]["material"] = {
      {"undrained_strength_Pa", 2e4},
      {"softening", {{"residual_undrained_strength_Pa", 5e3}, {"displacement_m", 0.1}}}};
  mutations.spoil(other);
  other["material"]["softening"] = {{"residual_cohesion_kPa", 0}, {"displacement_m", 0.1}};
  other["material"].erase("r_u");
  other["slide"]["outlines"][0].erase("material");
  mutations.spoil(other);
  other["material"] = {{"density_kg_m3", 1800},
                       {"undrained_strength_Pa", 2e4},
                       {"softening", {{"residual_undrained_strength_Pa", 5e3}, {"displacement_m", 0.1}}}};
  mutations.spoil(other);
  other = example("joined");
  other["water"] = {{"phreatic_line_csv", "case-bed.csv"}};
  mutations.spoil(other);
  other = example("joined");
  other["terrain"] = {{"ground_beyond_csv", "case-bed.csv"}};
  mutations.spoil(other);
  other = example("targets");
  mutations.spoil(other);
  const json structures = {other["targets"][3], other["targets"][4]};
  other["targets"] = structures;
  mutations.spoil(other);
  other["targets"] = {{{"name", "dam"}, {"structure", {{"outline_csv", "case-outline.csv"}}}}};
  other["study"]["hazard_classes"] = {{{"name", "high"}, {"dynamic_pressure_Pa", 1e4}, {"speed_m_s", 2}}};
  mutations.spoil(other);
  // Properties in all of their forms.
  other = example("properties");
  mutations.spoil(other);
  for (const auto& [key, suffix] : {std::pair("friction", "tan_phi"), std::pair("cohesion", "kPa"),
                                    std::pair("unit_weight", "kN_m3"), std::pair("viscosity", "Pa_s")}) {
    json& property = other["random_field"]["properties"][key];
    const auto with = [&, suffix = suffix](const char* stem) { return std::string(stem) + "_" + suffix; };
    property = {{"marginal", "normal"}, {with("mean"), 1}, {with("stdev"), 0.1}, {with("low"), 0.6}, {with("high"), 2}};
    for (const char* word : {"varies", "layers", "material"}) property[word] = "";
    property["varies"] = "in_space";
    property["layers"] = "one_field";
  }
  mutations.spoil(other);
  for (const auto& [key, suffix] : {std::pair("friction", "tan_phi"), std::pair("cohesion", "kPa"),
                                    std::pair("unit_weight", "kN_m3"), std::pair("viscosity", "Pa_s")})
    other["random_field"]["properties"][key] = {
        {std::string("log_mean_") + suffix, 0.1}, {"log_stdev", 0.1}, {"data", {{1, 1, 1, 0}}}};
  mutations.spoil(other);
  for (const char* key : {"friction", "cohesion", "unit_weight", "viscosity"})
    other["random_field"]["properties"][key] = {{"cov", 0.1}, {"data_csv", "case-log.csv"}};
  mutations.spoil(other);
  std::set<std::string> keys;
  collect(test::SchemaCheck("case").document(), "", keys);
  for (const std::string& key : keys) EXPECT_TRUE(mutations.visited().contains(key)) << key << " was never spoilt";
  EXPECT_GT(mutations.count(), 600u);
}

}  // namespace
}  // namespace talus
