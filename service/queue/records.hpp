#pragma once
// Jobs and their runs as the queue records them.

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/clock.hpp"
#include "study/quality_summary.hpp"
#include "study/store.hpp"
#include "support/measures.hpp"

namespace talus::service {

enum class JobState { accepted, running, successful, failed, dismissed };
/// The words of OGC API - Processes.
inline constexpr std::array job_words{"accepted", "running", "successful", "failed", "dismissed"};
inline bool ended(JobState s) { return s != JobState::accepted && s != JobState::running; }

enum class RunState { queued, leased, done, failed };
inline constexpr std::array run_words{"queued", "leased", "done", "failed"};

inline const char* word(JobState state) { return job_words[static_cast<std::size_t>(state)]; }
inline const char* word(RunState state) { return run_words[static_cast<std::size_t>(state)]; }

template <class State, std::size_t n>
std::optional<State> state_of(const std::array<const char*, n>& words, const std::string& word) {
  const auto at = std::find(words.begin(), words.end(), word);
  return at == words.end() ? std::nullopt : std::optional(static_cast<State>(at - words.begin()));
}
inline std::optional<JobState> job_state(const std::string& word) { return state_of<JobState>(job_words, word); }
inline std::optional<RunState> run_state(const std::string& word) { return state_of<RunState>(run_words, word); }

/// A job as it is submitted.
struct NewJob {
  std::string id;
  std::string process;
  std::string subject;  ///< who owns it
  std::string title = {};
  std::string inputs = "{}";  ///< what the process needs later, JSON; the values of echo are kept apart
  std::int64_t seed = 0;
  std::int64_t planned = 0;     ///< realizations
  std::int64_t replicates = 0;  ///< of realization 0, for the numerical noise
  double max_failed_share = 1.0;
  bool may_stop_early = false;
  std::string case_hash = {};
  double particles = 0;
  double steps = 0;  ///< of one realization
};

struct Job : NewJob {
  std::int64_t number = 0;  ///< of its row; grows from job to job
  JobState state = JobState::accepted;
  std::string message = {};  ///< of an ended job: how it ended; of an open one: why none of its runs is under way
  Milliseconds created = 0, updated = 0;
  std::optional<Milliseconds> started = {}, finished = {};
  std::int64_t done = 0, failed = 0;  ///< realizations
  std::int64_t replicates_ended = 0;  ///< done or failed
  QualityCounts quality = {};         ///< of the realizations
  std::int64_t version = 1;           ///< grows with every change
};

struct Run {
  std::int64_t job = 0;  ///< Job::number
  RunKey key;
  RunState state = RunState::queued;
  std::int64_t attempt = 0, crashes = 0;
  std::optional<Record> result = {};
  std::optional<Failure> failure = {};
  bool damaged = false;  ///< it is done, and its record does not agree with its checksum
};

/// The hash of a run's key and record as the queue keeps it; numbers that were not recorded are left out.
std::string checksum_of(std::int64_t job, const RunKey& key, const Record& record);

/// The targets of a record as the queue keeps them, JSON; unset: it has none.
std::optional<std::string> targets_text(const Record& record);
/// The way back. @return false where the text is damaged
bool read_targets_text(const std::optional<std::string>& text, Record& record);

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
  const Measure* measure = &measure_table[0];  ///< to which the bounds apply
  std::optional<double> least = {}, below = {}, most = {};
  std::int64_t after = -1;
  int limit = 100;
};

/// The response to a request with an Idempotency-Key, repeated when the request comes again.
struct StoredResponse {
  std::string subject, key, body_hash;
  int status = 0;
  std::string location = {}, body = {};
};

/// How many jobs and runs are in each state, for /metrics.
struct StateCounts {
  std::array<std::int64_t, 5> jobs{};  ///< by JobState
  std::array<std::int64_t, 4> runs{};  ///< by RunState, of all jobs that are not dismissed
};

}  // namespace talus::service
