#pragma once
// Files of a job that are damaged or lost: found, and made again where something else holds what they held.

#include <vector>

#include "jobs/config.hpp"
#include "queue/store.hpp"

namespace talus::service {

/// The case of a job, which is made again from job.json where it is missing or differs from it.
/// @throws IoError where the directory is missing, or both are lost
std::filesystem::path checked_case(const DataDirectory& data, const Job& job);

/// Replaces plan.json and the marker of a job's directory by those of `made`, a study prepared from the case of the
/// job, where they are damaged or missing; and writes job.json again where that is so.
/// @throws IoError where `made` is of another case than the job
void repair_directory(const DataDirectory& data, const Job& job, const std::filesystem::path& made);

/// The runs that are done in the queue, and whose result file is missing.
std::vector<RunKey> missing_results(const DataDirectory& data, const Job& job, Store& store);

/// The runs that are done in the queue, and whose result file is missing, damaged, or of another digest. A file of
/// another run is given another name, with the ending .foreign, so that the run can be repeated.
/// @throws StorageError, IoError
std::vector<RunKey> lost_results(const DataDirectory& data, const Job& job, Store& store);

}  // namespace talus::service
