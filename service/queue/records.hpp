#pragma once
// What the queue keeps: jobs, and beneath each its runs.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/clock.hpp"
#include "study/record.hpp"
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

struct Run {
  std::int64_t job = 0;  ///< Job::number
  RunKey key;
  RunState state = RunState::queued;
  std::int64_t attempt = 0, crashes = 0;
  std::optional<Record> result = {};
  std::optional<Failure> failure = {};
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
