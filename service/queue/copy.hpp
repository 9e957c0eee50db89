#pragma once
// Copies of the queue, for backups; the queue may be in use.

#include <filesystem>
#include <set>
#include <string>

namespace talus::service {

/// Copies the queue as it is at one moment, with all that is committed, and checks the pages of the copy. Neither waits
/// for a running talusd nor makes it wait.
/// @throws StorageError
void copy_queue(const std::filesystem::path& from, const std::filesystem::path& to);

/// The ids of the studies in a queue that are dismissed, or of those that are not.
/// @throws StorageError
std::set<std::string> studies_in(const std::filesystem::path& queue, bool dismissed);

/// Dismisses jobs in a queue that nobody uses, as Store::dismiss does.
/// @throws StorageError
void dismiss_jobs(const std::filesystem::path& queue, const std::set<std::string>& ids);

}  // namespace talus::service
