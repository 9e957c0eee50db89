#pragma once
// A copy of queue and jobs that a talusd can start from, made while one runs.

#include <set>

#include "jobs/config.hpp"

namespace talus::service {

struct BackupReport {
  std::size_t jobs = 0, files = 0;
  std::uint64_t bytes = 0;             ///< of the files of the jobs
  std::set<std::string> missing = {};  ///< jobs that have no directory
};

/// Copies the queue, then the directory of each of its studies without the working directories of its runs: every run
/// that is done in the copied queue has its result in the copied directory. Runs under way start over in a talusd that
/// is started on the copy; jobs submitted after the copy began are not in it.
/// @param target  does not exist, or is an empty directory. It holds no queue.sqlite until the copy is complete.
/// @throws StorageError, IoError, std::filesystem::filesystem_error
BackupReport back_up(const DataDirectory& data, const std::filesystem::path& target);

}  // namespace talus::service
