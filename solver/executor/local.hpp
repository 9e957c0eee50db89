#pragma once
// Runs as processes of this machine.

#include <chrono>
#include <list>

#include "executor/executor.hpp"

namespace talus::executor {

/// All runs are killed by the destructor.
class LocalExecutor final : public Executor {
 public:
  /// @param places  runs at a time
  explicit LocalExecutor(int places) : places_(static_cast<std::size_t>(places)) {}

  bool has_room() const override { return workers_.size() < places_; }
  RunId start(const Run& run) override;
  std::vector<Ended> poll() override;
  void stop_all() override;
  void kill(RunId id) override;
  std::string pending_reason(const std::string&) const override { return {}; }
  bool outlives_this_process() const override { return false; }

 private:
  struct Worker {
    RunId id;
    bool resumed;
    std::chrono::steady_clock::time_point deadline;
    bool timed_out = false;
    Process process;
  };
  std::size_t places_;
  RunId last_ = 0;
  std::list<Worker> workers_;
};

}  // namespace talus::executor
