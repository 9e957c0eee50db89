#pragma once
// The process that gives its inputs back.

#include "support/json.hpp"

namespace talus::service {

/// The inputs without wrappings. @throws Refusal with everything that is wrong
Json read_echo_inputs(const Json& inputs);

/// The outputs named.
Json echo_results(const Json& inputs, const std::vector<std::string>& outputs);

}  // namespace talus::service
