#pragma once
// Whether the data directory that talusd writes to is still the one that stands under its path.

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "jobs/config.hpp"

namespace talus::service {

/// Remembers which files the data directory, its jobs and the queue are. Thread-safe.
class DataWatch {
 public:
  /// @param data  exists, with its queue
  /// @throws IoError
  explicit DataWatch(const DataDirectory& data);

  /// @throws Refusal unavailable where one of them has been removed or replaced: what is written is lost
  void check() const;

 private:
  using Identity = std::pair<dev_t, ino_t>;
  static std::optional<Identity> identity(const std::filesystem::path& path);

  std::vector<std::pair<std::filesystem::path, Identity>> known_;
};

}  // namespace talus::service
