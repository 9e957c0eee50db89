#pragma once
// The results of a process in the form that the client requested.

#include "http/message.hpp"

namespace talus::service {

/// A results document; or, of a request with "response": "raw", the value itself, and of several values a
/// multipart/related, unless the client accepts JSON alone.
/// @param values  name to bare value
Answer results_answer(const Json& values, bool raw, const Incoming& request);

/// The values of the named outputs of echo.
Json echo_results(const Json& inputs, const std::vector<std::string>& outputs);

}  // namespace talus::service
