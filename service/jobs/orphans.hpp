#pragma once
// Directories that the queue does not know: they are put aside, never deleted, and can be taken back.

#include <set>
#include <string>
#include <vector>

#include "jobs/config.hpp"
#include "queue/store.hpp"

namespace talus::service {

/// Moves what the queue does not know from DATA/jobs, and what talusd did not make from DATA/scratch, to DATA/orphans,
/// and logs each. Deletes unfinished submissions and scratch files, which their names tell. Only while nobody submits.
/// @param known  ids of all jobs in the queue
/// @throws std::filesystem::filesystem_error
void put_orphans_aside(const DataDirectory& data, const std::set<std::string>& known);

/// The number of files and directories in DATA/orphans. Thread-safe.
std::size_t count_orphans(const DataDirectory& data);

/// What became of one entry of DATA/orphans.
struct Adoption {
  std::string name;
  bool adopted = false;
  std::string message;  ///< what the job has, or why the entry stays where it is
};

/// Takes jobs back from DATA/orphans, the oldest first: a job that the queue has lost is recorded again from its
/// job.json and its results, and a job of the queue without a directory gets its directory back. Runs without a result
/// are queued. Everything else stays where it is. Only while no scheduler works on the store.
/// @throws StorageError, IoError, std::filesystem::filesystem_error
std::vector<Adoption> adopt_orphans(const DataDirectory& data, Store& store);

/// At start: writes the job.json of jobs that have none, restores rows of the queue that differ from theirs, and logs
/// these and jobs whose directory is missing.
/// @throws StorageError
void check_job_records(const DataDirectory& data, Store& store);

}  // namespace talus::service
