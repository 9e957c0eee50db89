// What an array task of Slurm does on its machine.

#include <signal.h>

#include <chrono>
#include <cstdlib>
#include <iostream>
#include <utility>

#include "executor/slurm_batch.hpp"
#include "executor/watch.hpp"
#include "support/text.hpp"

namespace talus::executor {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// The signals that we wait for instead of being interrupted by them.
class Signals {
 public:
  Signals() {
    sigemptyset(&set_);
    for (const int number : {SIGCHLD, SIGTERM, SIGINT}) sigaddset(&set_, number);
    sigprocmask(SIG_BLOCK, &set_, nullptr);
  }
  /// Waits for a second at most.
  void wait() {
    const timespec second{1, 0};
    const int number = sigtimedwait(&set_, nullptr, &second);
    if (number == SIGTERM || number == SIGINT) asked_to_stop_ = true;
  }
  bool asked_to_stop() const { return asked_to_stop_; }

 private:
  sigset_t set_;
  bool asked_to_stop_ = false;
};

/// Whether a run that was asked to stop stopped before it had finished.
bool broke_off(const ProcessEnd& end) {
  return end.signal != 0 || end.exit_code == Exit::interrupted || end.exit_code == Exit::sigterm;
}

class ArrayTask {
 public:
  ArrayTask(const BatchDirectory& batch, std::size_t index) : batch_(batch), index_(index) {}

  void execute(const std::vector<Run>& runs) {
    for (std::size_t position = 0; position < runs.size() && !signals_.asked_to_stop(); ++position) {
      const RunPlace place{index_, position};
      if (batch_.has_status(place)) continue;
      const RunStatus status =
          batch_.is_killed(place) ? RunStatus{.end = {.signal = SIGKILL}} : outcome(runs[position], place);
      if (signals_.asked_to_stop() && broke_off(status.end)) return;
      batch_.write_status(place, status);
    }
  }

 private:
  RunStatus outcome(const Run& run, RunPlace place) try { return execute(run, place); } catch (const IoError& e) {
    return {.end = {.exit_code = static_cast<int>(Exit::io)}, .why = e.what()};
  }

  RunStatus execute(const Run& run, RunPlace place) {
    RunStatus status{.resumed = fs::exists(run.directory / "checkpoint.h5")};
    Command command = run.command;
    command.arguments.emplace_back("--resume");  // also where there is nothing to resume, or where it is finished
    const Clock::time_point begin = Clock::now();
    Process process(command, run.log, run.log);
    Watch watch(command.limits);
    bool told = false;
    for (std::optional<ProcessEnd> end; !(end = process.poll());) {
      signals_.wait();
      if (signals_.asked_to_stop() && !std::exchange(told, true)) process.ask_to_end();
      watch.look(process);
      if (batch_.is_killed(place)) process.signal(SIGKILL);
    }
    status.timed_out = watch.timed_out();
    status.why = watch.why();
    status.end = *process.poll();
    status.seconds = seconds_since(begin);
    return status;
  }

  const BatchDirectory& batch_;
  std::size_t index_;
  Signals signals_;
};

}  // namespace

int execute_array_task(const BatchDirectory& batch) {
  const char* text = std::getenv("SLURM_ARRAY_TASK_ID");
  const std::optional<std::int64_t> given = to_integer(text ? text : "");
  if (!given) {
    std::cerr << "SLURM_ARRAY_TASK_ID is not the index of an array task\n";
    return 2;
  }
  const auto index = static_cast<std::size_t>(*given);
  if (const auto runs = batch.runs(index))
    ArrayTask(batch, index).execute(*runs);
  else
    std::cerr << batch.path().string() << " holds no runs for this task (any more)\n";
  return 0;
}

}  // namespace talus::executor
