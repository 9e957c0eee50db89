#pragma once
// What the queue keeps: jobs, and beneath each its runs.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/clock.hpp"
#include "support/measures.hpp"

namespace talus::service {

enum class JobState { accepted, running, successful, failed, dismissed };
/// "accepted", ...: the words of OGC API - Processes.
const char* word(JobState state);
std::optional<JobState> job_state(const std::string& word);
inline bool ended(JobState s) { return s != JobState::accepted && s != JobState::running; }

enum class RunState { queued, leased, done, failed };
const char* word(RunState state);
std::optional<RunState> run_state(const std::string& word);

/// What a job is when it is handed in.
struct NewJob {
  std::string id;
  std::string process;
  std::string subject;  ///< who owns it
  std::string title = {};
  std::string inputs = "{}";  ///< as the process needs them later, JSON
  std::int64_t seed = 0;
  std::int64_t planned = 0;  ///< realizations
  std::int64_t floor = 0;    ///< replicates for the noise floor
  double max_failed_share = 1.0;
  bool may_stop_early = false;
  std::string case_hash = {};
  double particles = 0;
  double steps = 0;  ///< of one realization
};

struct Job : NewJob {
  std::int64_t number = 0;  ///< its row; grows with time
  JobState state = JobState::accepted;
  std::string message = {};  ///< how it ended; until then why none of its runs is under way
  Milliseconds created = 0, updated = 0;
  std::optional<Milliseconds> started = {}, finished = {};
  std::int64_t done = 0, failed = 0;  ///< realizations
  std::int64_t floor_made = 0;        ///< replicates, done or failed
  std::int64_t version = 1;           ///< counts the changes
};

/// A run of a job: a realization, or a replicate (k = 1, 2, ...) of realization 0 for the noise floor.
struct RunKey {
  std::int64_t job = 0;  ///< Job::number
  bool floor = false;
  std::int64_t index = 0;
  bool operator==(const RunKey&) const = default;
};

/// A run handed to a worker. Only who holds the current attempt may say how it ended.
struct Claim {
  RunKey run;
  std::string job_id;
  std::int64_t seed = 0;
  std::int64_t attempt = 1;  ///< grows with every claim
  std::int64_t crashes = 0;  ///< attempts that ended by themselves without a result
};

/// What a finished run says of itself.
struct RunResult {
  Measures measures;
  double mean_friction_angle_deg = 0.0;
  std::optional<double> captured_variance = {};  ///< [-]; unset in runs of before it was kept
  std::int64_t steps = 0;
  double wall_clock = 0.0;  ///< [s]
  std::string digest;
};

/// Why a run failed.
struct RunFailure {
  std::string reason;  ///< one line
  std::optional<int> exit_code = {}, signal = {};
  std::string log_tail = {};
};

struct Run {
  RunKey key;
  RunState state = RunState::queued;
  std::int64_t attempt = 0, crashes = 0;
  std::optional<RunResult> result = {};
  std::optional<RunFailure> failure = {};
};

/// Which jobs to list, newest first.
struct JobFilter {
  std::optional<std::string> subject = {};
  std::vector<JobState> states = {};
  std::vector<std::string> processes = {};
  std::optional<Milliseconds> created_from = {}, created_to = {};
  std::optional<Milliseconds> least_duration = {}, most_duration = {};  ///< from started to finished, or to now
  std::optional<std::int64_t> before = {};                              ///< Job::number of the last one seen
  int limit = 100;
};

/// Which realizations to list, by index.
struct RunFilter {
  std::optional<RunState> state = {};
  const Measure* measure = &measure_table[0];  ///< that the bounds are about
  std::optional<double> least = {}, below = {}, most = {};
  std::int64_t after = -1;
  int limit = 100;
};

/// An answer kept for a request with an Idempotency-Key.
struct Remembered {
  std::string subject, key, body_hash;
  int status = 0;
  std::string location = {}, body = {};
};

/// Numbers for /metrics.
struct Census {
  std::array<std::int64_t, 5> jobs{};  ///< by JobState
  std::array<std::int64_t, 4> runs{};  ///< by RunState, of all jobs that are not dismissed
};

}  // namespace talus::service
