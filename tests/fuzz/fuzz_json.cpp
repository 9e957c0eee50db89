// Bytes as JSON: within the limits, the parser takes what the library's own parser takes, and makes the same of it.

#include <cstdlib>

#include "support/json.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const talus::JsonLimits limits{.nesting = 8, .values = 200, .members = 20, .string = 100};
  try {
    const talus::Json document = talus::parse_json(text, "fuzz.json", limits);
    if (!talus::Json::accept(text) || talus::Json::parse(text) != document) std::abort();
  } catch (const talus::ConfigError& e) {
    if (e.faults.empty()) std::abort();
  }
  return 0;
}
