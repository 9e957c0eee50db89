// Runs as processes of this machine.

#include <signal.h>

#include <chrono>
#include <list>

#include "executor/executor.hpp"

namespace talus::executor {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

class LocalExecutor final : public Executor {
 public:
  explicit LocalExecutor(int most_workers) : most_workers_(static_cast<std::size_t>(most_workers)) {}

  bool has_room() const override { return workers_.size() < most_workers_; }

  RunId start(const Run& run) override {
    const bool resume = fs::exists(run.directory / "checkpoint.h5");
    if (!resume) fs::remove_all(run.directory);
    Command command = run.command;
    if (resume) command.arguments.emplace_back("--resume");
    const std::uint64_t limit = command.limits.wall_seconds;
    workers_.push_back({.id = ++last_,
                        .resumed = resume,
                        .deadline = limit == 0 ? Clock::time_point::max() : Clock::now() + std::chrono::seconds(limit),
                        .process = Process(command, run.log, run.log)});
    return last_;
  }

  std::vector<Ended> poll() override {
    std::vector<Ended> all;
    std::erase_if(workers_, [&](Worker& worker) {
      const auto end = worker.process.poll();
      if (end) all.push_back({.id = worker.id, .end = *end, .resumed = worker.resumed, .timed_out = worker.timed_out});
      if (!end && !worker.timed_out && Clock::now() > worker.deadline) {
        worker.timed_out = true;
        worker.process.signal(SIGKILL);
      }
      return end.has_value();
    });
    return all;
  }

  void stop_all() override {
    for (const Worker& worker : workers_) worker.process.signal(SIGTERM);
  }
  void kill(RunId id) override {
    for (const Worker& worker : workers_)
      if (worker.id == id) worker.process.signal(SIGKILL);
  }
  std::string pending_reason(const std::string&) const override { return {}; }
  bool outlives_this_process() const override { return false; }

 private:
  struct Worker {
    RunId id;
    bool resumed;
    Clock::time_point deadline;
    bool timed_out = false;
    Process process;
  };
  std::size_t most_workers_;
  RunId last_ = 0;
  std::list<Worker> workers_;
};

}  // namespace

std::unique_ptr<Executor> make_local_executor(int most_workers) {
  return std::make_unique<LocalExecutor>(most_workers);
}

}  // namespace talus::executor
