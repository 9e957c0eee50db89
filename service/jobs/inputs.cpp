#include "jobs/inputs.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "support/text.hpp"

namespace talus::service {
namespace {

/// What the value of an input must be.
struct InputRule {
  const char* name;
  bool (*holds)(const Json&);
  const char* text;
};

/// @return the rule of an input; null where the process has no such input
const InputRule* find_rule(std::span<const InputRule> rules, const std::string& name) {
  const auto at = std::find_if(rules.begin(), rules.end(), [&](const InputRule& rule) { return name == rule.name; });
  return at == rules.end() ? nullptr : &*at;
}

bool is_whole(const Json& value) {
  return value.is_number_integer() ||
         (value.is_number_float() && value.get<double>() == std::floor(value.get<double>()));
}
bool is_whole(const Json& value, std::int64_t least, std::int64_t most) {
  return is_whole(value) && value >= least && value <= most;
}
bool is_number(const Json& value, double least, double most) {
  return value.is_number() && value >= least && value <= most;
}
bool is_array(const Json& value) { return value.is_array(); }
bool is_object(const Json& value) { return value.is_object(); }
bool is_string(const Json& value) { return value.is_string(); }
bool is_text(const Json& value) { return value.is_string() && value.get_ref<const std::string&>().size() <= 4000; }
bool is_box(const Json& value) {
  if (!value.is_object() || !value.contains("bbox")) return false;
  const Json& box = value["bbox"];
  return box.is_array() && (box.size() == 4 || box.size() == 6) &&
         std::all_of(box.begin(), box.end(), [](const Json& x) { return x.is_number(); }) &&
         (!value.contains("crs") || value["crs"].is_string());
}

/// The inputs of `influence-zone`; those between the first and the last are keys of the case's /study, too.
constexpr InputRule study_rules[] = {
    {"case", is_object, "must be an object: a Talus case"},
    {"realizations", [](const Json& v) { return is_whole(v, 1, 1'000'000'000); },
     "must be a whole number from 1 to 1000000000"},
    {"seed", [](const Json& v) { return is_whole(v, 0, max_exact_integer); },
     "must be a whole number from 0 to 9007199254740991"},
    {"noise_floor_replicates", [](const Json& v) { return is_whole(v, 0, 1000); },
     "must be a whole number from 0 to 1000"},
    {"max_failed_share", [](const Json& v) { return is_number(v, 0.0, 1.0); }, "must be a number from 0 to 1"},
    {"histogram_edges_m", is_array, "must be an array of numbers"},
    {"quantity", is_string, "must be a string"}};

constexpr InputRule echo_rules[] = {
    {"s", is_text, "must be a string of at most 4000 bytes"},
    {"pause", [](const Json& v) { return is_number(v, 0.0, 60.0); }, "must be a number of seconds from 0 to 60"},
    {"a",
     [](const Json& v) {
       return v.is_array() && v.size() <= 1000 &&
              std::all_of(v.begin(), v.end(), [](const Json& item) { return is_whole(item); });
     },
     "must be an array of at most 1000 integers"},
    {"b", is_box, "must be {\"bbox\": [4 or 6 numbers]}, optionally with a crs"},
    {"o", is_object, "must be an object"},
    {"m", is_text, "must be a string of at most 4000 bytes"},
    {"x", [](const Json& v) { return v.is_number() || v.is_boolean() || is_text(v); },
     "must be a string, a number or a boolean"}};

/// Rejects keys that name a file: over HTTP they would name a file of the server.
void refuse_files(const Json& value, const std::string& pointer, Faults& faults) {
  if (value.is_object()) {
    for (const auto& [key, member] : value.items()) {
      const std::string place = pointer_to(pointer, key);
      if (key == "data_csv")
        faults.add(place, "names a file; over HTTP give the data themselves, as data: [[x, y, value, error], ...]");
      else if (key.ends_with("_csv"))
        faults.add(place,
                   "names a file; over HTTP give the vertices themselves, as " + key.substr(0, key.size() - 3) + "m");
      refuse_files(member, place, faults);
    }
  } else if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i) refuse_files(value[i], pointer_to(pointer, i), faults);
  }
}

/// The bare value of an input, which may be given as {"value": ...}. Links are rejected: nothing is fetched.
Json unqualified(const Json& input, const std::string& pointer, Faults& faults) {
  if (!input.is_object()) return input;
  if (input.contains("href") && !input.contains("value")) {
    faults.add(pointer + "/href", "inputs by reference are not fetched; give the value itself");
    return nullptr;
  }
  const bool qualified = input.contains("value") && std::all_of(input.items().begin(), input.items().end(), [](auto m) {
                           return m.key() == "value" || m.key() == "mediaType" || m.key() == "encoding" ||
                                  m.key() == "schema" || m.key() == "format";
                         });
  return qualified ? input.at("value") : input;
}

}  // namespace

std::vector<std::string> read_outputs(const Json& request, const std::vector<std::string>& known, Faults& faults) {
  if (!request.contains("outputs")) return known;
  const Json& outputs = request.at("outputs");
  if (!outputs.is_object()) {
    faults.add("/outputs", "must be an object with a member for each output wanted");
    return known;
  }
  std::vector<std::string> wanted;
  for (const auto& [name, how] : outputs.items()) {
    const std::string pointer = pointer_to("/outputs", name);
    if (std::find(known.begin(), known.end(), name) == known.end())
      faults.add(pointer, "is not an output of this process");
    else if (!how.is_object())
      faults.add(pointer, "must be an object");
    else if (how.contains("transmissionMode") && how.at("transmissionMode") != "value")
      faults.add(pointer + "/transmissionMode", "must be \"value\"");
    else
      wanted.push_back(name);
  }
  return wanted.empty() ? known : wanted;
}

const Measure& quantity_of(const std::string& name, const std::string& pointer) {
  if (const Measure* measure = find_measure(name)) return *measure;
  std::string names;
  for (const Measure& measure : measure_table) names += (names.empty() ? "" : ", ") + std::string(measure.key);
  throw Refusal(reason::bad_request, "no such quantity", {{pointer, "must be one of " + names}});
}

StudyInputs read_study_inputs(const Json& inputs) {
  Faults faults;
  for (const auto& [name, value] : inputs.items())
    if (!find_rule(study_rules, name)) faults.add(pointer_to("/inputs", name), "is not an input of this process");
  if (!inputs.contains("case")) faults.add("/inputs/case", "is missing");
  Json given = Json::object();
  for (const InputRule& rule : study_rules) {
    if (!inputs.contains(rule.name)) continue;
    const std::string pointer = std::string("/inputs/") + rule.name;
    Json value = unqualified(inputs.at(rule.name), pointer, faults);
    if (!rule.holds(value)) faults.add(pointer, rule.text);
    if (rule.name == std::string_view("case")) refuse_files(value, pointer, faults);
    given[rule.name] = is_whole(value) && rule.holds(value) ? Json(value.get<std::int64_t>()) : std::move(value);
  }
  refuse_if_any(faults, reason::bad_request, "the inputs are invalid");

  StudyInputs study{.document = given.at("case")};
  study.quantity = quantity_of(given.value("quantity", study.quantity), "/inputs/quantity").key;
  given.erase("case");
  given.erase("quantity");
  Json& options = study.document["study"];  // talus checks them there
  if (options.is_null()) options = Json::object();
  if (!options.is_object())
    throw Refusal(reason::bad_request, "the inputs are invalid", {{"/inputs/case/study", "must be an object"}});
  options.update(given);
  return study;
}

Json read_echo_inputs(const Json& inputs) {
  Faults faults;
  Json bare = Json::object();
  for (const auto& [name, given] : inputs.items()) {
    const std::string pointer = pointer_to("/inputs", name);
    const InputRule* rule = find_rule(echo_rules, name);
    if (!rule) {
      faults.add(pointer, "is not an input of this process");
      continue;
    }
    bare[name] = unqualified(given, pointer, faults);
    if (rule->holds(bare[name])) continue;
    bare[name] = given;  // an object that merely looks like a qualified value
    if (!rule->holds(given)) faults.add(pointer, rule->text);
  }
  if (!inputs.contains("s")) faults.add("/inputs/s", "is missing");
  refuse_if_any(faults, reason::bad_request, "the inputs are invalid");
  return bare;
}

Json echo_results(const Json& inputs, const std::vector<std::string>& outputs) {
  Json results = Json::object();
  for (const std::string& name : outputs)
    if (inputs.contains(name)) results[name] = inputs.at(name);
  return results;
}

}  // namespace talus::service
