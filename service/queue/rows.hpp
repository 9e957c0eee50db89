#pragma once
// Rows to structs, for the two halves of the store.

#include <SQLiteCpp/SQLiteCpp.h>

#include "queue/records.hpp"

namespace talus::service {

inline constexpr const char* job_columns =
    "number, id, process, subject, title, inputs, state, message, seed, planned, floor, max_failed_share, "
    "may_stop_early, case_hash, particles, steps, created, updated, started, finished, done, failed, floor_made, "
    "version";

/// The columns of a run: its key and state, its numbers in the order of their tables, and how it ended.
inline const std::string run_columns = [] {
  std::string columns = "job, floor, idx, state, attempt, crashes, ";
  const Record any;
  visit_numbers(any, [&](const char* key, const char*, auto) { columns += key + std::string(", "); });
  return columns + "digest, reason, exit_code, signal, log_tail";
}();

Job job_of(SQLite::Statement& row);
Run run_of(SQLite::Statement& row);
/// The kind of a run from its column `floor` (0, 1).
RunKind kind_of(const SQLite::Column& floor);
std::vector<Job> all_jobs(SQLite::Statement& query);

/// Says that a job has changed.
void touch(SQLite::Database& db, std::int64_t job, Milliseconds now);

}  // namespace talus::service
