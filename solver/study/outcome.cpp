#include "study/outcome.hpp"

#include <signal.h>

#include "support/error.hpp"

namespace talus {
namespace {

using Action = Outcome::Action;

/// A crash: another attempt, or, at the last one, `otherwise`.
Outcome crashed(const RunEnd& end, Action otherwise, const std::string& what, const std::string& said) {
  const int crashes = end.crashes + 1;
  if (crashes < end.attempts) return {.action = Action::retry, .crashed = true, .reason = what + said};
  return {.action = otherwise,
          .crashed = true,
          .reason = what + (crashes > 1 ? ", " + std::to_string(crashes) + " times" : "") + said};
}

}  // namespace

Outcome outcome_of(const RunEnd& end) {
  const executor::Ended& how = end.ended;
  const int signal = how.end.signal, code = how.end.exit_code;
  const std::string said = end.last_line.empty() ? "" : ": " + end.last_line;
  if (how.preempted) return {.action = Action::retry, .reason = how.why};
  if (end.wrong_result) return {.action = Action::abort, .reason = "left the result of another run or study"};
  if (how.timed_out || signal == SIGXCPU)
    return {.action = Action::failed,
            .reason = "took longer than the limit of " + std::to_string(end.time_limit_s) + " s" + said};
  const bool stopped = signal || code == Exit::interrupted || code == Exit::sigint || code == Exit::sigterm;
  if (stopped && end.stopping) return {.action = Action::retry};
  if (stopped) {
    std::string what = how.why;
    if (what.empty())
      what = signal ? "killed: " + executor::signal_text(signal)
                    : "stopped from outside (exit code " + std::to_string(code) + ")";
    return crashed(end, Action::failed, what, said);
  }
  if (code == Exit::ok && end.has_result) {
    if (end.invalid.empty()) return {.action = Action::done};
    return {.action = Action::failed, .reason = end.invalid};
  }
  if (code == Exit::ok) return crashed(end, Action::failed, "it ended well but left no readable result", said);
  if (code == Exit::usage || code == Exit::bad_case)
    return {.action = Action::abort, .bad_case = true, .reason = "refuses the case" + said};
  if (code == Exit::io) {
    if (how.resumed)
      return {.action = Action::retry, .discard_checkpoint = true, .reason = "cannot go on from its checkpoint" + said};
    if (end.disk_full) return {.action = Action::retry, .reason = "cannot read or write" + said};
    return crashed(end, Action::abort, "cannot read or write", said);
  }
  return {.action = Action::failed,
          .reason = (code == Exit::diverged ? "diverged" : "exit code " + std::to_string(code)) + said};
}

}  // namespace talus
