#include "process/short_command.hpp"

#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <thread>

#include "support/files.hpp"

namespace talus::service {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_out_bytes = std::size_t{64} << 20;

}  // namespace

CommandOutput run_to_end(const executor::Command& command, const fs::path& scratch, std::chrono::milliseconds limit,
                         const std::function<bool()>& give_up) {
  static std::atomic<unsigned> counter{0};
  const fs::path stem = scratch / ("command-" + std::to_string(::getpid()) + "-" + std::to_string(counter++));
  const fs::path out = stem.string() + ".out", err = stem.string() + ".err";
  struct Remover {
    const fs::path &a, &b;
    ~Remover() {
      ::unlink(a.c_str());
      ::unlink(b.c_str());
    }
  } const remover{out, err};

  CommandOutput outcome;
  executor::Process child(command, out, err);
  const auto deadline = std::chrono::steady_clock::now() + limit;
  std::chrono::milliseconds nap{1};
  for (std::optional<executor::ProcessEnd> end; !(end = child.poll()); std::this_thread::sleep_for(nap)) {
    if (!outcome.timed_out && (std::chrono::steady_clock::now() > deadline || (give_up && give_up()))) {
      outcome.timed_out = true;
      child.signal(SIGKILL);
    }
    nap = std::min(nap * 2, std::chrono::milliseconds(20));
  }
  outcome.end = *child.poll();
  outcome.out = find_file(out, max_out_bytes).value_or("");
  outcome.err = executor::tail(err, 4000);
  return outcome;
}

}  // namespace talus::service
