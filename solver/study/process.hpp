#pragma once
// A child process with an owner.

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace talus {

/// How a process ended.
struct ProcessEnd {
  int exit_code = 0;  ///< meaningless if killed
  int signal = 0;     ///< that killed it; 0: it left by itself
};

/// A running child: in a process group of its own, so that Ctrl-C at the terminal reaches only its parent; stdin empty,
/// stdout and stderr in a log file; default signal handling. Killed (SIGKILL) and reaped when the object goes while it
/// still runs.
class Process {
 public:
  /// @param arguments  the program first
  /// @throws IoError when the log cannot be created or the program cannot be started
  Process(const std::vector<std::string>& arguments, const std::filesystem::path& log);
  ~Process();
  Process(Process&& other) noexcept;
  Process& operator=(Process&&) = delete;

  pid_t pid() const { return pid_; }
  /// Whether and how it has ended; never waits.
  std::optional<ProcessEnd> poll();
  /// Sends a signal to it and to what it started, if it still runs.
  void signal(int number) const;

 private:
  pid_t pid_ = -1;
  std::optional<ProcessEnd> end_;
};

/// "Killed (signal 9)"
std::string signal_text(int number);

/// The last `max_bytes` of a text file; empty where it cannot be read.
std::string tail(const std::filesystem::path& path, std::size_t max_bytes);

}  // namespace talus
