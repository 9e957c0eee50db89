#pragma once
// The process echo, which returns its inputs.

#include "base/json.hpp"

namespace talus::service {

/// The inputs as plain values. @throws Refusal with every fault
Json read_echo_inputs(const Json& inputs);

/// The outputs named.
Json echo_results(const Json& inputs, const std::vector<std::string>& outputs);

}  // namespace talus::service
