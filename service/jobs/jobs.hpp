#pragma once
// Operations on jobs, for the HTTP handlers.

#include <atomic>
#include <mutex>

#include "base/shares.hpp"
#include "jobs/commands.hpp"
#include "jobs/data_watch.hpp"
#include "jobs/inputs.hpp"
#include "jobs/productions.hpp"
#include "jobs/result_cache.hpp"
#include "jobs/scheduler.hpp"
#include "process/short_command.hpp"
#include "queue/store.hpp"

namespace talus::service {

/// Thread-safe. Every function throws Refusal, StorageError or IoError.
class Jobs {
 public:
  Jobs(const Config& config, Store& store, Scheduler& scheduler);

  /// @throws Refusal unavailable where the data directory has been removed or replaced
  void check_data() const { data_watch_.check(); }
  /// Checks a study with `talus validate` and against the quotas, makes its directory and records it.
  /// @param response  stored under the Idempotency-Key of the request
  /// @return the job; nothing where another request has used the key meanwhile
  std::optional<Job> submit_study(const Submission& submission, const Store::Response& response);
  std::optional<Job> submit_echo(const Submission& submission, const Store::Response& response);
  void dismiss(const Job& job);
  /// Makes damaged and lost files of the job again and requeues the runs that have failed or whose result is lost.
  /// @throws Refusal conflict where the job cannot go on, since its directory or its case is lost
  void retry(const Job& job, const Store::Response& response);
  /// @return false where another request has used the key meanwhile
  bool extend(const Job& job, std::int64_t more, const Store::Response& response);

  /// How a quantity is distributed over the runs done so far, from the records in the database.
  Json distribution(const Job& job, const Measure& quantity, const Bins& bins);
  /// How likely a quantity of the realizations done so far is beyond x, what `talus stats --at` says: a measure, a
  /// number of a target ("house.peak_depth_m"), or whether a target is reached ("house", for which x is not used).
  /// @throws Refusal (bad_request) naming the parameter: no such quantity, x missing
  Json exceedance(const Job& job, const std::string& quantity, const std::optional<double>& x);
  /// study.json of a job that has ended.
  Json summary(const Job& job);
  /// The friction angles before the failure of the slope, as SVG or JSON.
  std::string field(const Job& job, std::int64_t index, bool svg, const Caller& caller);
  /// The particles at the end of a run, which is repeated for its snapshots. The 16 newest of a job are kept.
  std::string profile(const Job& job, std::int64_t index, bool svg, const Caller& caller);
  /// Runs a case with given coefficients of its random field. @return result.json
  Json evaluate(const Json& document, const Caller& caller);
  /// The output of `talus validate --json` for a document.
  /// @param pointer  where the document stands in the request, for the faults
  Json validate(const Json& document, const std::string& pointer, const Caller& caller);
  /// The number of coefficients of the random field of a case.
  std::size_t field_terms(const Json& document, const Caller& caller);

  /// Ends the commands under way and refuses new ones.
  void stop();

 private:
  void check_disk() const;
  /// @param pointer  of every fault; empty: that of the input concerned
  void check_size(double particles, double steps, std::int64_t realizations, const std::string& pointer = "") const;
  void check_queue(const std::string& subject) const;
  /// @param bytes  of the inputs of one more echo job
  void check_echo(const std::string& subject, std::size_t bytes) const;
  std::optional<Job> record(const NewJob& job, const Store::Response& response, Milliseconds created,
                            const std::optional<std::string>& echo_inputs = {});
  /// Runs a command for at most `limit`, or until it is abandoned. @throws Refusal where it cannot start, takes longer,
  /// or cannot read or write
  CommandOutput run(const Command& command, std::chrono::seconds limit, const Productions::Abandoned& abandoned);
  /// `talus ARGUMENTS` for a caller, when it has a place among the commands.
  CommandOutput run_command(std::vector<std::string> arguments, const Caller& caller);
  Json validate(const Json& document, const std::string& pointer, const Productions::Abandoned& abandoned);
  /// Makes `directory` that of a study, or extends the study in it.
  CommandOutput prepare(const std::filesystem::path& case_file, const StudyPaths& directory, std::int64_t realizations,
                        std::int64_t seed, const Caller& caller);
  /// @throws Refusal internal unless the command succeeded
  static void check_made(const CommandOutput& output, const std::string& what);
  std::string make_field(const Job& job, std::int64_t index, bool svg, const Productions::Abandoned& abandoned);
  std::string make_profile(const Job& job, std::int64_t index, const std::filesystem::path& kept,
                           const Productions::Abandoned& abandoned);
  std::string make_evaluation(const Json& document, const Productions::Abandoned& abandoned);
  TemporaryDirectory scratch_directory() const;
  void repair(const Job& job);
  /// The plan of a job for its present number of realizations, and its tables and study.json, written again.
  Plan plan_of(const Job& job);
  TargetSample target_sample(const Job& job, const Plan& plan, std::size_t target);
  void publish_again(const Job& job);

  const Config& config_;
  DataDirectory data_;
  DataWatch data_watch_;
  Store& store_;
  Scheduler& scheduler_;
  Shares commands_;            ///< short commands at a time
  Productions fields_, runs_;  ///< short commands, and runs outside the queue, for requests that share what they make
  std::atomic<bool> stopping_{false};
  std::mutex changing_study_;  ///< held by who writes the case, the plan or the marker of a job
  ResultCache distributions_, field_terms_;
};

}  // namespace talus::service
