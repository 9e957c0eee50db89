#pragma once
// Small studies for tests.

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "study/summary.hpp"
#include "temporary_directory.hpp"

namespace talus::fixtures {

using test::TemporaryDirectory;

inline std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

inline Plan plan(std::int64_t realizations) {
  Plan p{.title = "A slope", .of = {"0123456789abcdef", "family", 2.0}, .version = "0.1.0", .seed = 42, .study = {}};
  p.study.realizations = realizations;
  p.study.noise_floor_replicates = 0;
  return p;
}

/// A realization whose measures all differ.
inline Record done(std::int64_t index, double zone) {
  return {.index = index,
          .done = true,
          .measures = {zone, zone - 0.3, zone - 0.7, zone - 0.4, 0.5 * zone, zone - 0.6},
          .mean_phi_deg = 25.0 - 0.1 * static_cast<double>(index % 7),
          .captured_variance = 0.25,
          .front_thickness = 0.6,
          .steps = 1000 + index,
          .wall_clock = 1.5,
          .digest = "00000000000000" + std::to_string(10 + index % 90)};
}

inline Record failed(std::int64_t index, const std::string& reason) { return {.index = index, .reason = reason}; }

inline Json summarize(const Plan& plan, const std::vector<Record>& runs, const std::vector<Record>& floor) {
  return summary_of(plan, runs, floor).json();
}

}  // namespace talus::fixtures
