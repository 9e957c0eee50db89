#pragma once
// The outcome of one run: read from its result.json, or the record of its failure.

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "study/run_key.hpp"
#include "support/error.hpp"
#include "support/json.hpp"
#include "support/measures.hpp"
#include "support/quality.hpp"
#include "support/targets.hpp"

namespace talus {

/// A finished or failed run. Of a failed one only `index`, `reason` and, where its result is invalid, `verdict` and
/// `objections` mean anything.
struct Record {
  std::int64_t index = 0;          ///< realization, or replicate
  bool done = false;               ///< false: failed
  Measures measures = {};          ///< [m]; NaN: no value, or not recorded
  double mean_phi_deg = 0.0;       ///< mean friction angle over the soil particles [deg]
  double captured_variance = 0.0;  ///< [-]
  double front_thickness = 0.0;    ///< of the soil at measures.front_at_thickness [m]; NaN: not recorded
  std::int64_t steps = 0;
  double wall_clock = 0.0;        ///< [s]
  double left_domain = 0.0;       ///< soil particles that left through an open end; NaN: not recorded
  std::string digest = {};        ///< of the final state
  std::string lower_bounds = {};  ///< keys of the measures that are lower bounds, separated by blanks
  std::string reason = {};        ///< why it failed, one line; empty if done
  Verdict verdict = Verdict::not_assessed;
  std::string objections = {};              ///< objections_text() of the result's quality
  std::vector<TargetOutcome> targets = {};  ///< in the order of the case

  /// Whether soil that left the terrain makes a lower bound of this measure.
  bool is_lower_bound(const Measure& measure) const;
  /// [m]; unset: it failed
  std::optional<double> influence_zone() const { return done ? std::optional(measures.influence_zone) : std::nullopt; }
};

/// The record of a failed run; with the verdict where it failed because its result is invalid.
Record failed_record(std::int64_t index, std::string reason);
/// Why a run with an invalid result has failed; failed_record() understands it.
std::string reason_of_invalid(const std::string& objections);

/// A number of a run beside its measures: what it drew, and what it cost. One that a later version than 0.1.0 added is
/// a double, whose NaN says that it was not recorded.
struct Covariate {
  const char* key;     ///< in result.json, in the tables, and as SQL column
  const char* object;  ///< of result.json that holds it; null: the document itself
  std::variant<double Record::*, std::int64_t Record::*> member;
  bool later = false;  ///< added after version 0.1.0: results and tables of that version do not have it
};
inline constexpr std::array covariate_table{Covariate{"mean_friction_angle_deg", "field", &Record::mean_phi_deg},
                                            Covariate{"captured_variance", "field", &Record::captured_variance},
                                            Covariate{"steps", nullptr, &Record::steps},
                                            Covariate{"wall_clock_s", nullptr, &Record::wall_clock},
                                            Covariate{"left_domain", nullptr, &Record::left_domain, true},
                                            Covariate{"front_thickness_m", nullptr, &Record::front_thickness, true}};

/// Whether version 0.1.0 did not have the number of this key.
bool is_later(std::string_view key);
/// Whether a run may have no value of the measure of this key.
bool is_optional(std::string_view key);
/// Whether a result or table of an earlier version may be without this number: every measure but the first, and the
/// covariates that came later. It is NaN then.
bool may_be_missing(std::string_view key);

/// Calls `use(key, object, value)` for every number of a record, in the order of the tables and of the SQL columns: the
/// measures, then the covariates.
template <class AnyRecord, class Use>
void visit_numbers(AnyRecord& record, const Use& use) {
  const char* const document = nullptr;
  for (const Measure& measure : measure_table) use(measure.key, document, record.measures.*measure.member);
  for (const Covariate& of : covariate_table)
    std::visit([&](auto member) { use(of.key, of.object, record.*member); }, of.member);
}

/// No number of a run is larger: metres, seconds, steps and degrees stay far below. A larger one is damage.
inline constexpr double largest_number = 1e12;
/// More realizations than a study can have.
inline constexpr std::int64_t end_of_indices = 1'000'000'000;

/// The targets in the list of a result.json, and the list.
/// @throws IoError, Json::exception where it is not one
std::vector<TargetOutcome> read_outcomes(const Json& list);
Json outcomes_json(const std::vector<TargetOutcome>& targets);

/// Why a run failed.
struct Failure {
  std::string reason;  ///< one line
  std::optional<int> exit_code = {}, signal = {};
  std::string log_tail = {};
};

/// What tells the runs of one study from those of another.
struct StudyIdentity {
  std::uint64_t seed = 0;
  std::string case_hash;
  std::vector<std::string> earlier = {};  ///< Plan::earlier
};

/// A result.json of another run or another study.
struct ForeignResult : IoError {
  using IoError::IoError;
};

/// The record in a result.json of `key` that came to its end, a failed one where the result is invalid; nothing where
/// the file is missing, damaged, of an interrupted run, or of a run that still moved at an earlier end than the
/// study's: it is then carried out again. A result of an earlier version, which assessed nothing, is read too.
/// @throws ForeignResult
std::optional<Record> read_result(const std::filesystem::path& file, const RunKey& key, const StudyIdentity& of);

/// Writes the failure record of a run (000012.failed.json), whole or not at all.
/// @throws IoError
void write_failure(const StudyPaths& paths, const RunKey& key, const Failure& failure, std::int64_t attempts,
                   std::uint64_t seed);

/// The reason in a failure record, for failed_record(); nothing where it cannot be read.
std::optional<std::string> read_failure(const std::filesystem::path& file);

/// Keeps the snapshots of realization 0 as profiles/first.vtkhdf and those of the farthest so far as
/// profiles/worst.vtkhdf, each with its number and the hash of its snapshots in a JSON file of the same name. Does
/// nothing for a run that wrote no snapshots.
/// @param farthest  no recorded realization went farther
/// @throws IoError
void keep_profiles(const StudyPaths& paths, const RunKey& key, double influence_zone, bool farthest);

/// The profiles that a study keeps.
inline constexpr const char* first_profile = "first";
inline constexpr const char* farthest_profile = "worst";
/// Whether a profile of a study is missing or does not agree with the hash beside it. One without a hash was never
/// kept, or by an earlier version: nothing is known of it.
bool is_damaged_profile(const StudyPaths& paths, const std::string& profile);
/// The realizations whose profile is damaged, and which must be run again to have it.
/// @param farthest  the farthest realization recorded; unset: there is none
std::vector<std::int64_t> damaged_profiles(const StudyPaths& paths, std::optional<std::int64_t> farthest);

}  // namespace talus
