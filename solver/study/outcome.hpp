#pragma once
// What the end of a process means for its run: the retry rule.

#include <string>

#include "executor/executor.hpp"

namespace talus {

/// Crashes of a run after which it counts as failed. Machines differ, memory runs out and people cancel jobs, and a
/// study without such trouble never uses more than one attempt.
inline constexpr int default_attempts = 5;

/// What is known when the process of a run has ended.
struct RunEnd {
  executor::Ended ended;
  bool has_result = false;    ///< a whole result.json of this very run is there
  std::string invalid = {};   ///< why that result is invalid; empty: it is not
  bool wrong_result = false;  ///< a result.json of another run or study is there
  bool stopping = false;      ///< the front end has asked all runs to stop
  bool disk_full = false;
  int crashes = 0;  ///< of this run before
  int attempts = default_attempts;
  std::uint64_t time_limit_s = 0;  ///< of the run; 0: none
  std::string last_line = {};      ///< of its log
};

struct Outcome {
  enum class Action {
    done,    ///< take the result
    failed,  ///< record the failure; the realization stays in the denominator
    retry,   ///< run it again
    abort    ///< the study cannot go on: the case or the machine is at fault, not this draw
  };
  Action action = Action::done;
  bool crashed = false;             ///< with retry: counts towards `attempts`
  bool discard_checkpoint = false;  ///< with retry: start from the beginning
  bool bad_case = false;            ///< with abort: the case is at fault, not the machine
  std::string reason = {};          ///< one line; empty where there is nothing to say
  bool operator==(const Outcome&) const = default;
};

/// Pure; thread-safe.
///
/// | end of the process                              | outcome                                          |
/// |-------------------------------------------------|--------------------------------------------------|
/// | preempted, lost with its node                   | retry, not counted                               |
/// | exit code 0 with its result                     | done                                             |
/// | exit code 0 with an invalid result              | failed: it would end the same way again          |
/// | the result of another run                       | abort                                            |
/// | time limit (also SIGXCPU)                       | failed                                           |
/// | killed or stopped while the front end stops     | retry, not counted                               |
/// | killed or stopped otherwise; 0 without a result | retry, counted; failed at the last attempt       |
/// | 2 or 3 (usage, bad case)                        | abort                                            |
/// | 5 (input/output) after a start from a checkpoint | retry from the beginning, not counted           |
/// | 5, disk full                                    | retry, not counted                               |
/// | 5 otherwise                                     | retry, counted; abort at the last attempt        |
/// | 4 (diverged), any other                         | failed: it would end the same way again          |
Outcome outcome_of(const RunEnd& end);

}  // namespace talus
