#include "jobs/inputs.hpp"

#include <algorithm>
#include <cmath>

#include "queue/records.hpp"
#include "support/faults.hpp"
#include "support/text.hpp"

namespace talus::service {
namespace {

constexpr std::int64_t most_replicates = 1000;

/// Files beside the case are for people at the machine; over HTTP they would be ours.
void refuse_files(const Json& value, const std::string& pointer, Checker& check) {
  if (value.is_object()) {
    for (const auto& [key, member] : value.items()) {
      const std::string place = pointer_to(pointer, key);
      if (key.ends_with("_csv")) check.fault(place, "names a file; over HTTP give the vertices themselves");
      refuse_files(member, place, check);
    }
  } else if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i) refuse_files(value[i], pointer_to(pointer, i), check);
  }
}

std::optional<std::int64_t> integer(const Json& inputs, const char* key, std::int64_t least, std::int64_t most,
                                    Checker& check) {
  if (!inputs.contains(key)) return std::nullopt;
  const std::string pointer = std::string("/inputs/") + key;
  const Json value = unqualified(inputs.at(key), pointer, check);
  const double number = value.is_number() ? value.get<double>() : NAN;  // compared before it is cast: 1e300 is no int64
  if (!(number >= static_cast<double>(least) && number <= static_cast<double>(most) && number == std::floor(number))) {
    check.fault(pointer, "must be a whole number from " + std::to_string(least) + " to " + std::to_string(most));
    return std::nullopt;
  }
  return value.get<std::int64_t>();
}

}  // namespace

Json unqualified(const Json& input, const std::string& pointer, Checker& check) {
  if (!input.is_object()) return input;
  if (input.contains("href") && !input.contains("value")) {
    check.fault(pointer + "/href", "inputs by reference are not fetched; give the value itself");
    return nullptr;
  }
  const bool qualified = input.contains("value") && std::all_of(input.items().begin(), input.items().end(), [](auto m) {
                           return m.key() == "value" || m.key() == "mediaType" || m.key() == "encoding" ||
                                  m.key() == "schema" || m.key() == "format";
                         });
  return qualified ? input.at("value") : input;
}

std::vector<std::string> read_outputs(const Json& request, const std::vector<std::string>& known, Checker& check) {
  if (!request.contains("outputs")) return known;
  const Json& outputs = request.at("outputs");
  if (!outputs.is_object()) {
    check.fault("/outputs", "must be an object with a member for each output wanted");
    return known;
  }
  std::vector<std::string> wanted;
  for (const auto& [name, how] : outputs.items()) {
    const std::string pointer = pointer_to("/outputs", name);
    if (std::find(known.begin(), known.end(), name) == known.end())
      check.fault(pointer, "is not an output of this process");
    else if (!how.is_object())
      check.fault(pointer, "must be an object");
    else if (how.contains("transmissionMode") && how.at("transmissionMode") != "value")
      check.fault(pointer + "/transmissionMode", "must be \"value\"");
    else
      wanted.push_back(name);
  }
  return wanted.empty() ? known : wanted;
}

const Measure& quantity_of(const std::string& name, const std::string& pointer) {
  if (const Measure* measure = find_measure(name)) return *measure;
  std::string names;
  for (const Measure& measure : measure_table) names += (names.empty() ? "" : ", ") + std::string(measure.key);
  throw Refusal(Reason::bad_request, "no such quantity", {{pointer, "must be one of " + names}});
}

StudyInputs read_study_inputs(const Json& inputs) {
  Checker check;
  StudyInputs study;
  for (const auto& [key, value] : inputs.items()) {
    static constexpr const char* known[] = {
        "case", "realizations", "seed", "noise_floor_replicates", "max_failed_share", "histogram_edges_m", "quantity"};
    if (std::find(std::begin(known), std::end(known), key) == std::end(known))
      check.fault(pointer_to("/inputs", key), "is not an input of this process");
  }
  if (!inputs.contains("case")) {
    check.fault("/inputs/case", "is missing");
  } else {
    study.document = unqualified(inputs.at("case"), "/inputs/case", check);
    if (!study.document.is_object()) check.fault("/inputs/case", "must be an object: a Talus case");
    refuse_files(study.document, "/inputs/case", check);
  }
  const auto realizations = integer(inputs, "realizations", 1, 1'000'000'000, check);
  const auto seed = integer(inputs, "seed", 0, max_exact_integer, check);
  const auto floor = integer(inputs, "noise_floor_replicates", 0, most_replicates, check);
  std::optional<Json> share, edges;
  if (inputs.contains("max_failed_share")) {
    share = unqualified(inputs.at("max_failed_share"), "/inputs/max_failed_share", check);
    if (!share->is_number() || *share < 0 || *share > 1)
      check.fault("/inputs/max_failed_share", "must be a number from 0 to 1");
  }
  if (inputs.contains("histogram_edges_m")) {
    edges = unqualified(inputs.at("histogram_edges_m"), "/inputs/histogram_edges_m", check);
    if (!edges->is_array()) check.fault("/inputs/histogram_edges_m", "must be an array of numbers");
  }
  if (inputs.contains("quantity")) {
    const Json quantity = unqualified(inputs.at("quantity"), "/inputs/quantity", check);
    if (!quantity.is_string())
      check.fault("/inputs/quantity", "must be a string");
    else
      study.quantity = quantity.get<std::string>();
  }
  check.finish(Reason::bad_request, "the inputs are not right");
  quantity_of(study.quantity, "/inputs/quantity");

  // The options are keys of the case's study; talus checks them there.
  Json& options = study.document["study"];
  if (options.is_null()) options = Json::object();
  if (!options.is_object())
    throw Refusal(Reason::bad_request, "the inputs are not right", {{"/inputs/case/study", "must be an object"}});
  if (realizations) options["realizations"] = *realizations;
  if (seed) options["seed"] = *seed;
  if (floor) options["noise_floor_replicates"] = *floor;
  if (share) options["max_failed_share"] = *share;
  if (edges) options["histogram_edges_m"] = *edges;
  return study;
}

}  // namespace talus::service
