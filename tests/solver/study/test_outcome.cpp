// The retry rule, row by row.

#include <gtest/gtest.h>
#include <signal.h>

#include "study/outcome.hpp"

using namespace talus;

namespace {

using Action = Outcome::Action;

RunEnd left_with(int exit_code) {
  return {.ended = {.end = {.exit_code = exit_code}}, .time_limit_s = 60, .last_line = "said"};
}
RunEnd killed_by(int signal) { return {.ended = {.end = {.signal = signal}}, .time_limit_s = 60, .last_line = "said"}; }

template <class Change>
RunEnd with(RunEnd end, Change change) {
  change(end);
  return end;
}

struct Row {
  const char* name;
  RunEnd end;
  Outcome outcome;
};

const RunEnd lost = with(left_with(0), [](RunEnd& e) {
  e.ended.preempted = true;
  e.ended.why = "lost";
  e.crashes = 4;
});

// Four crashes before are one less than the default number of attempts.
const std::vector<Row> rows{
    {"done", with(left_with(0), [](RunEnd& e) { e.has_result = true; }), {.action = Action::done}},
    {"an invalid result",
     with(left_with(0),
          [](RunEnd& e) {
            e.has_result = true;
            e.invalid = "invalid result: a: b";
          }),
     {.action = Action::failed, .reason = "invalid result: a: b"}},
    {"done while stopping",
     with(left_with(0), [](RunEnd& e) { e.has_result = e.stopping = true; }),
     {.action = Action::done}},
    {"preempted", lost, {.action = Action::retry, .reason = "lost"}},
    {"no result",
     left_with(0),
     {.action = Action::retry, .crashed = true, .reason = "it ended well but left no readable result: said"}},
    {"no result, last attempt",
     with(left_with(0), [](RunEnd& e) { e.crashes = 4; }),
     {.action = Action::failed, .crashed = true, .reason = "it ended well but left no readable result, 5 times: said"}},
    {"the result of another run",
     with(left_with(0), [](RunEnd& e) { e.wrong_result = true; }),
     {.action = Action::abort, .reason = "left the result of another run or study"}},
    {"time limit",
     with(killed_by(SIGKILL), [](RunEnd& e) { e.ended.timed_out = true; }),
     {.action = Action::failed, .reason = "took longer than the limit of 60 s: said"}},
    {"CPU time limit",
     killed_by(SIGXCPU),
     {.action = Action::failed, .reason = "took longer than the limit of 60 s: said"}},
    {"killed",
     killed_by(SIGKILL),
     {.action = Action::retry, .crashed = true, .reason = "killed: Killed (signal 9): said"}},
    {"killed, last attempt",
     with(killed_by(SIGKILL), [](RunEnd& e) { e.crashes = 4; }),
     {.action = Action::failed, .crashed = true, .reason = "killed: Killed (signal 9), 5 times: said"}},
    {"killed, only attempt",
     with(killed_by(SIGKILL), [](RunEnd& e) { e.attempts = 1; }),
     {.action = Action::failed, .crashed = true, .reason = "killed: Killed (signal 9): said"}},
    {"killed, with the executor's reason",
     with(killed_by(SIGKILL), [](RunEnd& e) { e.ended.why = "out of memory"; }),
     {.action = Action::retry, .crashed = true, .reason = "out of memory: said"}},
    {"killed while stopping",
     with(killed_by(SIGKILL),
          [](RunEnd& e) {
            e.stopping = true;
            e.crashes = 4;
          }),
     {.action = Action::retry}},
    {"checkpoint while stopping", with(left_with(6), [](RunEnd& e) { e.stopping = true; }), {.action = Action::retry}},
    {"SIGTERM while stopping", with(left_with(143), [](RunEnd& e) { e.stopping = true; }), {.action = Action::retry}},
    {"checkpoint, asked by others",
     left_with(6),
     {.action = Action::retry, .crashed = true, .reason = "stopped from outside (exit code 6): said"}},
    {"interrupted, asked by others",
     left_with(130),
     {.action = Action::retry, .crashed = true, .reason = "stopped from outside (exit code 130): said"}},
    {"usage", left_with(2), {.action = Action::abort, .bad_case = true, .reason = "refuses the case: said"}},
    {"bad case", left_with(3), {.action = Action::abort, .bad_case = true, .reason = "refuses the case: said"}},
    {"input/output", left_with(5), {.action = Action::retry, .crashed = true, .reason = "cannot read or write: said"}},
    {"input/output, last attempt",
     with(left_with(5), [](RunEnd& e) { e.crashes = 4; }),
     {.action = Action::abort, .crashed = true, .reason = "cannot read or write, 5 times: said"}},
    {"full disk",
     with(left_with(5),
          [](RunEnd& e) {
            e.disk_full = true;
            e.crashes = 4;
          }),
     {.action = Action::retry, .reason = "cannot read or write: said"}},
    {"bad checkpoint",
     with(left_with(5),
          [](RunEnd& e) {
            e.ended.resumed = true;
            e.crashes = 4;
          }),
     {.action = Action::retry, .discard_checkpoint = true, .reason = "cannot go on from its checkpoint: said"}},
    {"diverged", left_with(4), {.action = Action::failed, .reason = "diverged: said"}},
    {"internal error", left_with(1), {.action = Action::failed, .reason = "exit code 1: said"}},
    {"without a word",
     with(left_with(1), [](RunEnd& e) { e.last_line.clear(); }),
     {.action = Action::failed, .reason = "exit code 1"}},
};

}  // namespace

TEST(Outcome, IsTheTable) {
  for (const Row& row : rows) {
    const Outcome outcome = outcome_of(row.end);
    EXPECT_EQ(outcome.reason, row.outcome.reason) << row.name;
    EXPECT_TRUE(outcome == row.outcome) << row.name;
  }
}
