#pragma once
// A child process that ends with the object that owns it.

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "support/error.hpp"

namespace talus::executor {

/// What a process may use at most; 0: no limit.
struct Limits {
  std::uint64_t memory_bytes = 0;  ///< address space
  std::uint64_t cpu_seconds = 0;
  std::uint64_t file_bytes = 0;     ///< of each file it writes
  std::uint64_t wall_seconds = 0;   ///< enforced by Watch, not by Process
  std::uint64_t stall_seconds = 0;  ///< time without any use of the CPU; enforced by Watch, not by Process
  bool core_dumps = true;
};

struct Command {
  std::vector<std::string> arguments;  ///< the program first; without a slash it is searched in PATH
  std::optional<std::vector<std::string>> environment = {};  ///< "NAME=value"; unset: that of this process
  Limits limits = {};
  int niceness = 0;
};

/// How a process ended.
struct ProcessEnd {
  int exit_code = 0;  ///< meaningless if killed
  int signal = 0;     ///< that killed it; 0: it exited
};

/// A running child: in its own process group, so that Ctrl-C at the terminal reaches only its parent; stdin empty,
/// stdout and stderr in files, which may be one; default signal handling. Killed (SIGKILL) with its group and reaped
/// when the object goes while it still runs.
class Process {
 public:
  /// @throws IoError when a file cannot be created or the program cannot be started
  Process(const Command& command, const std::filesystem::path& out, const std::filesystem::path& err);
  ~Process();
  Process(Process&& other) noexcept;
  Process& operator=(Process&&) = delete;

  pid_t pid() const { return pid_; }
  /// Whether and how it has ended; never waits. What it started and left behind is killed.
  std::optional<ProcessEnd> poll();
  /// Sends a signal to it and to what it started, if it still runs.
  void signal(int number) const;
  /// SIGTERM; a process that was stopped is continued to get it.
  void ask_to_end() const;

 private:
  pid_t pid_ = -1;
  std::optional<ProcessEnd> end_;
};

/// "Killed (signal 9)"
std::string signal_text(int number);

/// The last `max_bytes` of a text file; empty where it cannot be read.
std::string tail(const std::filesystem::path& path, std::size_t max_bytes);

/// The last line that is not blank.
std::string last_line(std::string text);

}  // namespace talus::executor
