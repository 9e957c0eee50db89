#pragma once
// What can be done with jobs; the HTTP side calls nothing else.

#include <atomic>
#include <map>
#include <mutex>
#include <semaphore>

#include "jobs/changes.hpp"
#include "jobs/commands.hpp"
#include "jobs/inputs.hpp"
#include "jobs/latest_answers.hpp"
#include "jobs/scheduler.hpp"
#include "process/short_command.hpp"
#include "queue/store.hpp"

namespace talus::service {

class Jobs {
 public:
  Jobs(const Config& config, Store& store, Scheduler& scheduler, Changes& changes);

  /// Checks a study with `talus validate`, refuses what is over the quotas, makes its directory and records it.
  /// @param raw  whether the client wants its results as they are, without a document around them
  /// @return nothing where `answer`'s Idempotency-Key has been used meanwhile
  /// @throws Refusal, StorageError, IoError
  std::optional<Job> submit_study(const std::string& subject, const Json& inputs,
                                  const std::vector<std::string>& outputs, bool raw, const Store::Answer& answer);
  std::optional<Job> submit_echo(const std::string& subject, const Json& inputs,
                                 const std::vector<std::string>& outputs, bool raw, const Store::Answer& answer);
  void dismiss(const Job& job);
  std::int64_t retry(const Job& job, const Store::Answer& answer);
  bool extend(const Job& job, std::int64_t more, const Store::Answer& answer);

  /// How a quantity is distributed over what is done so far, from the records in the database.
  Json distribution(const Job& job, const Measure& quantity, const Bins& bins);
  /// study.json of a job that has ended.
  Json summary(const Job& job) const;
  /// The friction angles before the slide; `svg` or JSON.
  std::string field(const Job& job, std::int64_t index, bool svg);
  /// The particles at the end, from the snapshots of a run made again; kept, the latest few.
  std::string profile(const Job& job, std::int64_t index, bool svg);
  /// Runs a case with given coefficients. @return result.json
  Json evaluate(const Json& document);
  /// What `talus validate --json` says of a document.
  /// @param pointer  put before the pointers of its faults
  /// @throws Refusal bad_request with the faults
  Json validate(const Json& document, const std::string& pointer);

  /// Ends what runs outside the queue, for good.
  void stop() { stopping_ = true; }

 private:
  void check_disk() const;
  /// @param only_at  where every fault is; otherwise where the inputs of a submission say it
  void check_size(double particles, double steps, std::int64_t realizations, const std::string& only_at = "") const;
  void check_queue(const std::string& subject) const;
  CommandOutput run(const Command& command, std::chrono::milliseconds limit, bool heavy = false);
  [[noreturn]] void refuse_case(const CommandOutput& outcome, const std::string& pointer) const;

  const Config& config_;
  DataDirectory data_;
  Store& store_;
  Scheduler& scheduler_;
  Changes& changes_;
  Commands commands_;
  std::counting_semaphore<64> quick_{4};  ///< short commands at a time
  std::counting_semaphore<1024> heavy_;   ///< runs outside the queue at a time
  std::atomic<bool> stopping_{false};
  std::mutex extending_;
  LatestAnswers distributions_;
};

}  // namespace talus::service
