#pragma once
// Carries out the runs of a store on an executor: claims them, starts their processes, and records how they end. Used
// by `talus study` (one study) and talusd (many).

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <set>

#include "executor/executor.hpp"
#include "study/store.hpp"

namespace talus {

/// Something that a front end may report.
struct RunEvent {
  enum class Kind { done, taken_over, failed, crashed, given_back, stale };
  Kind kind;
  const StudyInfo& study;
  const Claim& claim;
  std::string reason = {};  ///< of a failed, crashed or given back run; may be empty
  double wall_clock = 0.0;  ///< of a done one [s]
};

struct EngineOptions {
  int attempts = default_attempts;
  /// The program of a run, with absolute paths.
  std::function<executor::Command(const StudyInfo&, const RunKey&)> command;
  std::function<bool()> room_on_disk;           ///< unset: always
  std::function<void(const RunEvent&)> report;  ///< unset: nothing is reported
};

/// To be used by one thread. The poll rate is the caller's.
class Engine {
 public:
  Engine(Store& store, std::unique_ptr<executor::Executor> executor, EngineOptions options);

  /// Records every run that has ended. What cannot be recorded stays, and is recorded by a later call.
  /// @return whether there was one
  /// @throws what the store throws
  bool record_ended();
  /// Starts runs while the executor has room and the store has runs.
  /// @throws IoError where the disk is full or a process cannot be started, and what the store throws
  void start_runs();
  /// Renews the claims of all runs under way, and kills the runs whose claim is lost.
  void renew_claims();
  /// Asks all runs to checkpoint and end; what ends from now on does not count against its run.
  void stop();
  /// Gives all runs back that are still under way, and ends the executor. Local processes are killed.
  void close();

  std::size_t running() const { return runs_.size(); }
  std::set<StudyNumber> studies_running() const;
  /// The estimator of a study, read from the store where the engine has not seen it yet.
  const Estimator& estimator(StudyNumber number) { return open(number).estimator; }
  const StudyInfo& study(StudyNumber number) { return open(number).info; }
  /// Has a study read again before its next use: it has been extended, retried or dismissed.
  void forget(StudyNumber number);
  const executor::Executor& executor() const { return *executor_; }

 private:
  struct Study {
    StudyInfo info;
    Estimator estimator;
    bool stale = false;  ///< to be read again
  };
  struct UnderWay {
    Claim claim;
    std::uint64_t time_limit_s;
    std::optional<executor::Ended> ended = {};  ///< not recorded yet
    bool unwanted = false;  ///< killed, since its claim is lost or its study does not need it any more
  };

  Study& open(StudyNumber number);
  void start(const Claim& claim);
  bool stop_where_lost(const StudyInfo& info, StudyNumber number);
  bool take_over(const Claim& claim);
  void record(UnderWay& run);
  void record_done(const Claim& claim, const Record& record, RunEvent::Kind kind);
  void record_failed(const Claim& claim, const executor::Ended& how, const std::string& reason);
  void apply_decision(StudyNumber number);
  void kill_runs(StudyNumber number, bool replicates_too);
  void clear_work(const StudyPaths& paths, const RunKey& key) const;
  void report(RunEvent event) const {
    if (options_.report) options_.report(event);
  }
  bool room_on_disk() const { return !options_.room_on_disk || options_.room_on_disk(); }

  Store& store_;
  std::unique_ptr<executor::Executor> executor_;
  EngineOptions options_;
  std::map<StudyNumber, Study> studies_;
  std::map<executor::RunId, UnderWay> runs_;
  bool stopping_ = false;
};

/// `talus run` for one run of a study: the program and the arguments that both front ends use.
std::vector<std::string> run_arguments(const std::vector<std::string>& program, const StudyInfo& study,
                                       const RunKey& key, int threads);

}  // namespace talus
