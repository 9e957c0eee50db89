#pragma once
// job.json in the directory of a job: what a lost queue needs to make the row of the job again.

#include <filesystem>
#include <optional>

#include "queue/records.hpp"
#include "support/json.hpp"

namespace talus::service {

/// What submission fixes of a job, its resolved case, and when it was made. `planned` is that of the submission:
/// plan.json follows later extensions.
struct JobRecord {
  NewJob job;
  Milliseconds created = 0;
  Json document = {};  ///< case.resolved.json at submission
};

/// DIRECTORY/job.json
std::filesystem::path job_record_path(const std::filesystem::path& directory);

/// Writes it, with the case that stands in the directory, whole or not at all.
/// @throws IoError also where that case cannot be read
void write_job_record(const std::filesystem::path& directory, const NewJob& job, Milliseconds created);

/// Reads it; nothing where there is none.
/// @throws IoError where it is damaged
std::optional<JobRecord> find_job_record(const std::filesystem::path& directory);

}  // namespace talus::service
