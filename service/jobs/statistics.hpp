#pragma once
// Statistics of a job, made in this process from its records in the database.

#include "queue/store.hpp"
#include "study/summary.hpp"

namespace talus::service {

/// Writes realizations.csv, noise_floor.csv and study.json of a job into its directory, each by rename. The records are
/// streamed; memory: that of StudySummary.
/// @throws IoError, StorageError
StudySummary publish_study(Store& store, const Job& job, const Plan& plan, const StudyPaths& paths);

}  // namespace talus::service
