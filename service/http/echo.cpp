#include "http/echo.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "jobs/inputs.hpp"
#include "support/faults.hpp"

namespace talus::service {
namespace {

constexpr double longest_pause = 60.0;  // [s]
constexpr std::size_t longest_text = 4000, longest_array = 1000;

using Test = std::string (*)(const Json&);  ///< what is wrong, or nothing

std::string text(const Json& v) {
  return v.is_string() && v.get_ref<const std::string&>().size() <= longest_text
             ? ""
             : "must be a string of at most 4000 bytes";
}
std::string pause(const Json& v) {
  return v.is_number() && v >= 0.0 && v <= longest_pause ? "" : "must be a number of seconds from 0 to 60";
}
std::string integers(const Json& v) {
  const bool good = v.is_array() && v.size() <= longest_array && std::all_of(v.begin(), v.end(), [](const Json& item) {
                      return item.is_number_integer() ||
                             (item.is_number_float() && item.get<double>() == std::floor(item.get<double>()));
                    });
  return good ? "" : "must be an array of at most 1000 integers";
}
std::string box(const Json& v) {
  const bool good = v.is_object() && v.contains("bbox") && v["bbox"].is_array() &&
                    (v["bbox"].size() == 4 || v["bbox"].size() == 6) &&
                    std::all_of(v["bbox"].begin(), v["bbox"].end(), [](const Json& x) { return x.is_number(); }) &&
                    (!v.contains("crs") || v["crs"].is_string());
  return good ? "" : "must be {\"bbox\": [4 or 6 numbers]}, optionally with a crs";
}
std::string object(const Json& v) { return v.is_object() ? "" : "must be an object"; }
std::string one_of(const Json& v) {
  return v.is_number() || v.is_boolean() || (v.is_string() && text(v).empty())
             ? ""
             : "must be a string, a number or a boolean";
}

const std::map<std::string, Test>& tests() {
  static const std::map<std::string, Test> all = {{"s", text},   {"pause", pause}, {"a", integers}, {"b", box},
                                                  {"o", object}, {"m", text},      {"x", one_of}};
  return all;
}

}  // namespace

Json read_echo_inputs(const Json& inputs) {
  Checker check;
  Json bare = Json::object();
  for (const auto& [name, given] : inputs.items()) {
    const std::string pointer = pointer_to("/inputs", name);
    const auto test = tests().find(name);
    if (test == tests().end()) {
      check.fault(pointer, "is not an input of this process");
      continue;
    }
    bare[name] = unqualified(given, pointer, check);
    if (test->second(bare[name]).empty()) continue;
    bare[name] = given;  // an object that merely looks like a qualified value
    if (const std::string wrong = test->second(given); !wrong.empty()) check.fault(pointer, wrong);
  }
  if (!inputs.contains("s")) check.fault("/inputs/s", "is missing");
  check.finish(Reason::bad_request, "the inputs are invalid");
  return bare;
}

Json echo_results(const Json& inputs, const std::vector<std::string>& outputs) {
  Json results = Json::object();
  for (const std::string& name : outputs)
    if (inputs.contains(name)) results[name] = inputs.at(name);
  return results;
}

}  // namespace talus::service
