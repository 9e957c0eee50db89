#pragma once
// What a client may ask of a process, checked and with every fault told at once.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/json.hpp"
#include "support/measures.hpp"

namespace talus::service {

/// The inputs of `influence-zone`.
struct StudyInputs {
  Json document;  ///< the case, with the options put into its /study
  std::int64_t realizations = 0;
  std::optional<std::int64_t> seed;
  std::string quantity = "influence_zone_m";
  std::string title;
};

/// @throws Refusal bad_request
StudyInputs read_study_inputs(const Json& inputs);

/// Any input may come bare, or as {"value": ...}; a link is refused: nothing is fetched.
/// @return the bare value
Json unqualified(const Json& input, const std::string& pointer, Checker& check);

/// Everything that is wrong with the outputs asked for ("outputs": {"name": {...}}). @return their names; all where
/// none are asked for
std::vector<std::string> read_outputs(const Json& request, const std::vector<std::string>& known, Checker& check);

/// The measure of this name. @throws Refusal bad_request naming `pointer`
const Measure& quantity_of(const std::string& name, const std::string& pointer);

}  // namespace talus::service
