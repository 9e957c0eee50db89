#pragma once
// What a study set out to do; plan.json in its directory decides whether a later command is the same study.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "study/spec.hpp"

namespace talus {

struct Plan {
  std::string title;
  std::string case_hash;  ///< of the resolved case
  std::string version;    ///< of the program that runs it
  std::uint64_t seed = 0;
  StudySpec study;  ///< `study.seed` is not used
};

/// The plan of the study in `directory`, or nothing where there is none.
/// @throws IoError when there is one that cannot be read
std::optional<Plan> find_plan(const std::filesystem::path& directory);

/// Writes plan.json into `directory`.
void write_plan(const std::filesystem::path& directory, const Plan& plan);

/// Refuses to let `asked` go on where `begun` was begun, unless it is the same study or a longer one.
/// @throws ConfigError naming every difference that forbids it
void check_continues(const Plan& begun, const Plan& asked, const std::filesystem::path& directory);

}  // namespace talus
