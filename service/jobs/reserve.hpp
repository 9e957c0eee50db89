#pragma once
// Space on the disk that talusd keeps for what frees space: deleting jobs, and starting.

#include "jobs/config.hpp"

namespace talus::service {

/// Makes DATA/reserve where it is missing and there is room for it; does nothing otherwise.
void make_reserve(const DataDirectory& data) noexcept;
/// Frees the reserve. @return whether there was one
bool release_reserve(const DataDirectory& data) noexcept;
/// Whether the exception under way says that the disk is full. Only in a handler.
bool is_disk_full();

/// Runs `action`; where it fails since the disk is full, frees the reserve and runs it once more.
template <class Action>
auto with_reserve(const DataDirectory& data, const Action& action) {
  try {
    return action();
  } catch (...) {
    if (!is_disk_full() || !release_reserve(data)) throw;
  }
  return action();
}

}  // namespace talus::service
