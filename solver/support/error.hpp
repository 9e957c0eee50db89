#pragma once
// The error doctrine: three exceptions at the edge, each with an exit code of its own; and all exit codes.

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace talus {

/// One fault of an input: where it is (a JSON pointer, or file:line) and what is wrong with it.
struct Fault {
  std::string pointer;  ///< "/material/cohesion_Pa"; empty for the document as a whole
  std::string message;  ///< "\"5 kPa\" is not a number; give pascals, for example 5000"
};

/// A case that cannot be run; carries every fault found. Exit code 3.
struct ConfigError : std::runtime_error {
  explicit ConfigError(std::vector<Fault> all) : std::runtime_error(join(all)), faults(std::move(all)) {}
  ConfigError(std::string pointer, std::string message)
      : ConfigError(std::vector<Fault>{{std::move(pointer), std::move(message)}}) {}
  std::vector<Fault> faults;

 private:
  static std::string join(const std::vector<Fault>& all) {
    std::string text;
    for (const Fault& f : all)
      text += (text.empty() ? "" : "\n") + (f.pointer.empty() ? f.message : f.pointer + ": " + f.message);
    return text;
  }
};

/// A particle state became non-finite or implausibly fast. Exit code 4.
struct DivergedError : std::runtime_error {
  DivergedError(const std::string& what, std::int64_t step_, double time_, std::int64_t particle_)
      : std::runtime_error(what), step(step_), time(time_), particle(particle_) {}
  std::int64_t step;      ///< step at whose end it was seen
  double time;            ///< [s]
  std::int64_t particle;  ///< id of the first particle concerned
};

/// A file or directory could not be read or written. Exit code 5.
struct IoError : std::runtime_error {
  using std::runtime_error::runtime_error;
  int error = 0;  ///< errno of the call that failed; 0 where none did
};

/// Exit codes of every program of Talus.
enum class Exit : int {
  ok = 0,
  internal = 1,
  usage = 2,
  bad_case = 3,
  diverged = 4,
  io = 5,
  interrupted = 6,
  too_many_failed = 7,
  sigint = 130,
  sigterm = 143
};
constexpr bool operator==(int code, Exit exit) { return code == static_cast<int>(exit); }

}  // namespace talus
