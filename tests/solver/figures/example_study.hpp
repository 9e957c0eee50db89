#pragma once
// A small study of known numbers, as records and as the files that a study leaves.

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "study/publish.hpp"

namespace talus::test {

/// Realization i ran 30 + i / 10 m at a mean friction angle of 25 - i / 10 degrees; the last of `made` failed if
/// `one_failed`.
inline std::vector<Record> example_records(int made, bool one_failed) {
  std::vector<Record> records;
  for (int i = 0; i < made; ++i) {
    Record r;
    r.index = i;
    r.done = !(one_failed && i == made - 1);
    if (r.done) {
      const double x = 30 + 0.1 * i;
      r.measures = {x, 0.99 * x, 0.97 * x, 0.98 * x, 0.5 * x, 0.96 * x};
      r.mean_phi_deg = 25 - 0.1 * i;
      r.captured_variance = 0.0154;
      r.steps = 100;
      r.wall_clock = 1.0;
      r.digest = "0123456789abcdef";
    } else {
      r.reason = "diverged, \"step 3\", particle 7";
    }
    records.push_back(r);
  }
  return records;
}

inline Plan example_plan(int planned, const std::string& title = "Example") {
  Plan plan{.title = title, .of = {.hash = "0123456789abcdef"}, .version = "0.1.0", .seed = 42, .study = {}};
  plan.study.realizations = planned;
  return plan;
}

/// Writes the tables and study.json.
inline void write_example_study(const std::filesystem::path& directory, const Plan& plan,
                                const std::vector<Record>& runs, const std::vector<Record>& floor) {
  write_tables({directory}, plan, runs, floor);
}

/// Replicates of realization 0 of the example that differ by centimetres.
inline std::vector<Record> example_floor() {
  std::vector<Record> floor = example_records(3, false);
  for (Record& r : floor) r.measures.influence_zone = 30.01 + 0.01 * static_cast<double>(r.index);
  return floor;
}

}  // namespace talus::test
