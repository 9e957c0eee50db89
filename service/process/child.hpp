#pragma once
// A child process with an owner.

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace talus::service {

/// What a child may use at most; 0: no limit.
struct Limits {
  std::uint64_t memory_bytes = 0;  ///< address space
  std::uint64_t cpu_seconds = 0;
  std::uint64_t file_bytes = 0;  ///< of each file it writes
};

struct Command {
  std::vector<std::string> arguments;  ///< the program first, as a path
  int threads = 1;                     ///< OMP_NUM_THREADS
  Limits limits = {};
  int niceness = 0;
};

/// How a process ended.
struct End {
  int exit_code = 0;  ///< meaningless if killed
  int signal = 0;     ///< that killed it; 0: it left by itself
};

/// A running child in a process group of its own, with an environment of our making, stdin empty, stdout and stderr in
/// files, default signal handling. Its whole group is killed (SIGKILL) and reaped when the object goes.
class Child {
 public:
  /// @throws FileError when a file cannot be created or the program cannot be started
  Child(const Command& command, const std::filesystem::path& out, const std::filesystem::path& err);
  ~Child();
  Child(Child&& other) noexcept;
  Child& operator=(Child&&) = delete;

  pid_t pid() const { return pid_; }
  /// Whether and how it has ended; never waits.
  std::optional<End> poll();
  /// Sends a signal to it and to what it started, if it still runs.
  void signal(int number) const;

 private:
  pid_t pid_ = -1;
  std::optional<End> end_;
};

/// What a short command said.
struct Outcome {
  End end;
  bool timed_out = false;
  std::string out;
  std::string err;
};

/// Runs a command to its end, its output through files in `scratch`. It is killed after `limit`, or when `give_up` says
/// so.
/// @throws FileError
Outcome run_to_end(const Command& command, const std::filesystem::path& scratch, std::chrono::milliseconds limit,
                   const std::function<bool()>& give_up = {});

/// "Killed (signal 9)"
std::string signal_text(int number);

}  // namespace talus::service
