#pragma once
// Runs a short command to its end and returns its output.

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "executor/process.hpp"

namespace talus::service {

/// A directory that is removed with this object unless it is kept.
class TemporaryDirectory {
 public:
  /// @throws IoError
  explicit TemporaryDirectory(std::filesystem::path path);
  ~TemporaryDirectory();
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;
  /// Moves it to its final place, durably. @throws IoError
  void move_to(const std::filesystem::path& place);
  void keep() { kept_ = true; }
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
  bool kept_ = false;
};

/// Before the random name of a directory that run_to_end() makes in `scratch`.
inline constexpr std::string_view command_prefix = "command-";

struct CommandOutput {
  executor::ProcessEnd end;
  bool timed_out = false;
  std::string out;  ///< at most 64 MiB
  std::string err;  ///< its last 4000 bytes
  bool ok() const { return end.signal == 0 && end.exit_code == 0; }
};

/// Runs a command to its end. It is killed after `limit`, or when `give_up` returns true (polled at least every 20 ms).
/// Thread-safe.
/// @param scratch  for files with its output, removed at the end
/// @throws IoError
CommandOutput run_to_end(const executor::Command& command, const std::filesystem::path& scratch,
                         std::chrono::milliseconds limit, const std::function<bool()>& give_up = {});

}  // namespace talus::service
