#pragma once
// Case documents to start from, and the faults that loading one gives.

#include <string>
#include <vector>

#include "case/load.hpp"
#include "support/json.hpp"

namespace talus::test {

/// The shortest sound case; 43 m2 of soil on a slope that meets the flat at x = 10.
inline Json minimal() {
  return Json::parse(R"({
    "title": "Small slope", "particle_spacing_m": 0.5,
    "terrain": {"bed_m": [[0, 5], [10, 0], [40, 0]]},
    "slide": {"outlines": [{"outline_m": [[0, 5], [10, 0], [12, 0], [5, 8], [0, 8]]}]},
    "material": {"density_kg_m3": 2000, "friction_angle_deg": 30},
    "time": {"end_s": 5}})");
}

/// The minimal case with the value at one pointer set.
inline Json with(const std::string& pointer, Json value, Json document = minimal()) {
  document[Json::json_pointer(pointer)] = std::move(value);
  return document;
}

inline LoadedCase load(const Json& document, const std::vector<std::string>& overrides = {}) {
  return load_case(document, "/nonexistent", overrides);
}

/// "pointer: message" of every fault, none for a sound case.
inline std::vector<std::string> faults_of(const Json& document, const std::vector<std::string>& overrides = {}) {
  std::vector<std::string> lines;
  try {
    load(document, overrides);
  } catch (const ConfigError& e) {
    for (const Fault& f : e.faults) lines.push_back(f.pointer + ": " + f.message);
  }
  return lines;
}

}  // namespace talus::test
