#pragma once
// Rows to structs, for the two halves of the store.

#include <SQLiteCpp/SQLiteCpp.h>

#include "queue/records.hpp"

namespace talus::service {

inline constexpr const char* job_columns =
    "number, id, process, subject, title, inputs, state, message, seed, planned, floor, max_failed_share, "
    "may_stop_early, case_hash, particles, steps, created, updated, started, finished, done, failed, floor_made, "
    "version";

inline constexpr const char* run_columns =
    "job, floor, idx, state, attempt, crashes, influence_zone_m, front_connected_m, front_mass_99_m, front_mass_999_m, "
    "centre_of_mass_x_m, mean_friction_angle_deg, steps, wall_clock_s, digest, reason, exit_code, signal, log_tail";

Job job_of(SQLite::Statement& row);
Run run_of(SQLite::Statement& row);
std::vector<Job> all_jobs(SQLite::Statement& query);

/// Says that a job has changed.
void touch(SQLite::Database& db, std::int64_t job, Milliseconds now);

}  // namespace talus::service
