#pragma once
// What a study asks for and set out to do; plan.json in its directory decides whether a later command is the same
// study.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "support/output_directory.hpp"
#include "support/targets.hpp"

namespace talus {

/// What a Monte Carlo study asks for.
enum class Sampling { monte_carlo, latin_hypercube };

/// How bad the flow at a target is, by thresholds that a user sets.
struct HazardClass {
  std::string name;
  std::optional<double> depth = {};             ///< least peak depth [m], > 0; unset: any
  std::optional<double> speed = {};             ///< least peak speed [m/s], > 0; unset: any
  std::optional<double> dynamic_pressure = {};  ///< least peak dynamic pressure [Pa], > 0; unset: any
  bool operator==(const HazardClass&) const = default;
};

struct StudySpec {
  std::int64_t realizations = 100;    ///< planned, >= 1
  std::optional<std::uint64_t> seed;  ///< unset: random_seed(), recorded
  int noise_floor_replicates = 4;     ///< runs that differ by a relative 1e-6 of tan(phi) from realization 0; 0: none
  Sampling sampling = Sampling::monte_carlo;
  int stratified_modes = 5;               ///< leading modes that Latin hypercube sampling stratifies, >= 1
  std::optional<double> stop_half_width;  ///< stop once the 95 % interval of the mean influence zone is this narrow [m]
  double max_failed_share = 0.1;          ///< more failures than this end the study with exit code 7, in [0, 1]
  std::vector<double> histogram_edges;    ///< [m], increasing; empty: chosen from the data at round numbers
  std::vector<HazardClass> hazard_classes = {};  ///< from the weakest to the strongest
  bool operator==(const StudySpec&) const = default;
};

/// Independent standard normal numbers that every realization draws: the leading coefficients of a field, or the one
/// of a property that is drawn once.
struct DrawnNumbers {
  std::string name;        ///< of the property: "friction", "cohesion of clay"
  std::uint32_t key = 0;   ///< number of the field, as standard_normal() takes it
  std::int64_t count = 0;  ///< coefficients, the most important first; 0: they have no such order
  bool operator==(const DrawnNumbers&) const = default;
};

struct Plan {
  std::string title;
  CaseIdentity of;      ///< of the resolved case
  std::string version;  ///< of the program that runs it
  std::uint64_t seed = 0;
  StudySpec study;                        ///< `study.seed` is not used
  std::vector<TargetName> targets = {};   ///< of the case, in its order
  std::vector<std::string> earlier = {};  ///< hashes of the case with earlier ends, whose runs at rest are kept
  std::vector<DrawnNumbers> draws = {};   ///< what a realization draws; empty: nothing, or not known
};

/// The plan of the study in `directory`, or nothing where there is none.
/// @throws IoError when there is one that cannot be read
std::optional<Plan> find_plan(const std::filesystem::path& directory);

/// Writes plan.json into `directory`.
void write_plan(const std::filesystem::path& directory, const Plan& plan);

/// Refuses to let `asked` go on where `begun` was begun, unless it is the same study or a longer one: of more
/// realizations or, with `resume`, of a later end.
/// @throws IoError naming every difference that forbids it
void check_continues(const Plan& begun, const Plan& asked, const std::filesystem::path& directory, bool resume);

}  // namespace talus
