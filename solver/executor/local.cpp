#include "executor/local.hpp"

#include <signal.h>

namespace talus::executor {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

Clock::time_point deadline_of(const Limits& limits) {
  return limits.wall_seconds == 0 ? Clock::time_point::max() : Clock::now() + std::chrono::seconds(limits.wall_seconds);
}

}  // namespace

RunId LocalExecutor::start(const Run& run) {
  const bool resume = fs::exists(run.directory / "checkpoint.h5");
  if (!resume) fs::remove_all(run.directory);
  Command command = run.command;
  if (resume) command.arguments.emplace_back("--resume");
  workers_.push_back({.id = ++last_,
                      .resumed = resume,
                      .deadline = deadline_of(command.limits),
                      .process = Process(command, run.log, run.log)});
  return last_;
}

std::vector<Ended> LocalExecutor::poll() {
  std::vector<Ended> all;
  for (auto worker = workers_.begin(); worker != workers_.end();) {
    if (const auto end = worker->process.poll()) {
      all.push_back({.id = worker->id, .end = *end, .resumed = worker->resumed, .timed_out = worker->timed_out});
      worker = workers_.erase(worker);
      continue;
    }
    if (!worker->timed_out && Clock::now() > worker->deadline) {
      worker->timed_out = true;
      worker->process.signal(SIGKILL);
    }
    ++worker;
  }
  return all;
}

void LocalExecutor::stop_all() {
  for (const Worker& worker : workers_) worker.process.signal(SIGTERM);
}

void LocalExecutor::kill(RunId id) {
  for (const Worker& worker : workers_)
    if (worker.id == id) worker.process.signal(SIGKILL);
}

}  // namespace talus::executor
