#include "executor/watch.hpp"

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <sstream>

namespace talus::executor {
namespace {

constexpr std::chrono::milliseconds between_readings{200};  ///< of the CPU time
/// That a reading counts at most: whoever was itself stopped for a while does not take its processes for hanging.
constexpr std::chrono::seconds longest_counted{2};

}  // namespace

std::optional<double> cpu_seconds_of(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string line;
  if (!std::getline(file, line)) return std::nullopt;
  const std::size_t name_end = line.rfind(')');  // the name may contain anything
  if (name_end == std::string::npos) return std::nullopt;
  std::istringstream fields(line.substr(name_end + 1));
  std::string skipped;
  for (int field = 3; field < 14; ++field) fields >> skipped;  // proc(5): state is field 3, utime 14, stime 15
  double user = 0.0, system = 0.0;
  if (!(fields >> user >> system)) return std::nullopt;
  return (user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

bool Watch::hangs(const Process& process, Clock::time_point now) {
  if (limits_.stall_seconds == 0 || now - read_at_ < between_readings) return false;
  const std::optional<double> used = cpu_seconds_of(process.pid());
  const bool idle = used && used == cpu_seconds_;
  idle_ = idle ? idle_ + std::min<Clock::duration>(now - read_at_, longest_counted) : Clock::duration{};
  read_at_ = now;
  cpu_seconds_ = used;
  return idle_ > std::chrono::seconds(limits_.stall_seconds);
}

void Watch::look(const Process& process) {
  const Clock::time_point now = Clock::now();
  if (limits_.wall_seconds > 0 && now - begin_ > std::chrono::seconds(limits_.wall_seconds)) {
    timed_out_ = true;
    process.signal(SIGKILL);
  } else if (kill_at_) {
    if (now > *kill_at_) process.signal(SIGKILL);
  } else if (hangs(process, now)) {
    why_ = "hung: no CPU time used for " + std::to_string(limits_.stall_seconds) + " s";
    kill_at_ = now + std::min(patience, std::chrono::seconds(limits_.stall_seconds));
    process.ask_to_end();
  }
}

}  // namespace talus::executor
