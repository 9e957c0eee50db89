#pragma once
// What a study set out to do; plan.json in its directory decides whether a later command is the same study.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "case/load.hpp"
#include "monte_carlo/study_spec.hpp"

namespace talus {

struct Plan {
  std::string title;
  std::string case_hash;  ///< LoadedCase::hash
  std::string version;    ///< of the program that runs it
  std::uint64_t seed = 0;
  StudySpec study;  ///< `study.seed` is not used
};

/// The plan of a study of `loaded` with a given seed.
/// @throws ConfigError when the study cannot be done: every realization would be the same, or a Latin hypercube asked
/// to stop early
Plan make_plan(const LoadedCase& loaded, std::uint64_t seed, const std::string& version);

/// A seed for who gives none: from the clock, below 2^53 so that every JSON reader keeps it.
std::uint64_t seed_from_clock();

/// The plan of the study in `directory`, or nothing where there is none.
/// @throws IoError when there is one that cannot be read
std::optional<Plan> find_plan(const std::filesystem::path& directory);

/// Writes plan.json into `directory`.
void write_plan(const std::filesystem::path& directory, const Plan& plan);

/// Refuses to let `asked` go on where `begun` was begun, unless it is the same study or a longer one.
/// @throws ConfigError naming every difference that forbids it
void check_continues(const Plan& begun, const Plan& asked, const std::filesystem::path& directory);

}  // namespace talus
