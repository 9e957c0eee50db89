// Runs as processes of this machine.

#include <signal.h>

#include <list>

#include "executor/executor.hpp"
#include "executor/watch.hpp"

namespace talus::executor {
namespace {

namespace fs = std::filesystem;

class LocalExecutor final : public Executor {
 public:
  explicit LocalExecutor(int most_workers) : most_workers_(static_cast<std::size_t>(most_workers)) {}

  bool has_room() const override { return workers_.size() < most_workers_; }

  RunId start(const Run& run) override {
    const bool resume = fs::exists(run.directory / "checkpoint.h5");
    if (!resume) fs::remove_all(run.directory);
    Command command = run.command;
    if (resume) command.arguments.emplace_back("--resume");
    workers_.push_back({.id = ++last_,
                        .resumed = resume,
                        .watch = Watch(command.limits),
                        .process = Process(command, run.log, run.log)});
    return last_;
  }

  std::vector<Ended> poll() override {
    std::vector<Ended> all;
    std::erase_if(workers_, [&](Worker& worker) {
      const auto end = worker.process.poll();
      if (!end) {
        worker.watch.look(worker.process);
        return false;
      }
      all.push_back({.id = worker.id,
                     .end = *end,
                     .resumed = worker.resumed,
                     .timed_out = worker.watch.timed_out(),
                     .why = worker.watch.why()});
      return true;
    });
    return all;
  }

  void stop_all() override {
    for (const Worker& worker : workers_) worker.process.ask_to_end();
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
    Watch watch;
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
