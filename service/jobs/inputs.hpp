#pragma once
// The inputs and outputs of a request for a process, checked; every fault is reported at once.

#include <string>
#include <vector>

#include "base/json.hpp"
#include "base/shares.hpp"
#include "support/measures.hpp"

namespace talus::service {

/// A request to carry out a process.
struct Submission {
  Caller caller;  ///< who owns the job
  Json inputs = Json::object();
  std::vector<std::string> outputs = {};  ///< their names
  bool raw = false;                       ///< the client wants the bare values, without a document around them
};

/// The inputs of `influence-zone`.
struct StudyInputs {
  Json document;  ///< the case, with the options put into its /study
  std::string quantity = measure_table[0].key;
};

/// @throws Refusal bad_request
StudyInputs read_study_inputs(const Json& inputs);

/// The inputs of `echo` as bare values. @throws Refusal bad_request
Json read_echo_inputs(const Json& inputs);

/// The values of the named outputs of `echo`.
Json echo_results(const Json& inputs, const std::vector<std::string>& outputs);

/// The outputs that a request names ("outputs": {"name": {...}}), or all.
std::vector<std::string> read_outputs(const Json& request, const std::vector<std::string>& known, Faults& faults);

/// The measure of this name. @throws Refusal bad_request naming `pointer`
const Measure& quantity_of(const std::string& name, const std::string& pointer);

}  // namespace talus::service
