#pragma once
// The queue in SQLite: jobs, their runs, and the responses stored under an Idempotency-Key.

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "queue/database.hpp"
#include "queue/records.hpp"
#include "study/directory_store.hpp"
#include "study/publish.hpp"
#include "study/store.hpp"
#include "study/summary.hpp"

namespace talus::service {

/// Thread-safe. Every function throws StorageError where the database cannot be read or written.
class Store final : public talus::Store {
 public:
  /// @param jobs   where the directories of the jobs are
  /// @param lease  how long a claim stays valid without renewal [ms]
  /// @throws StorageError
  Store(const std::filesystem::path& path, std::filesystem::path jobs, Clock clock, Milliseconds lease)
      : db_(path), jobs_(std::move(jobs)), clock_(std::move(clock)), lease_(lease) {}

  // Jobs.

  /// Makes the response that is stored under an Idempotency-Key, from the job after the change.
  using Response = std::function<StoredResponse(const Job&)>;

  /// Records a job and its runs; durable when this returns.
  /// @param response  stored in the same transaction; unset: the request had no key
  /// @param created  unset: now
  /// @param echo_inputs  of an echo job: the values that it repeats, JSON, kept until it is dismissed
  /// @return the job; nothing where another request has used the key meanwhile
  std::optional<Job> create(const NewJob& job, const Response& response = {},
                            const std::optional<Milliseconds>& created = {},
                            const std::optional<std::string>& echo_inputs = {});
  /// The values of an echo job; "{}" where there are none.
  std::string echo_inputs(std::int64_t job);
  /// How many bytes of them are kept, of one subject or of all.
  std::int64_t echo_bytes(const std::optional<std::string>& subject);
  /// Records a job again that the queue has lost, with the outcomes that its directory holds; the rest is queued.
  /// @param created  when it was first recorded
  Job recreate(const NewJob& job, Milliseconds created, const Records& runs, const Records& replicates);
  std::optional<Job> job(const std::string& id);
  std::optional<Job> job(std::int64_t number);
  std::vector<Job> jobs(const JobFilter& filter);
  /// The number of jobs that are accepted or running, of one subject or of all.
  std::int64_t open_jobs(const std::optional<std::string>& subject);
  /// The ids of the jobs in a state, or of all.
  std::set<std::string> job_ids(const std::optional<JobState>& state = {});
  StateCounts state_counts();
  /// Visits the studies that are not dismissed, one at a time.
  void visit_studies(const std::function<void(const Job&)>& visit);

  /// Records why no run of an open job is under way; empty: the reason is unknown.
  void note_pending_reason(std::int64_t job, const std::string& why);
  /// Makes an accepted job running. @return false if it was not accepted
  bool start(std::int64_t job);
  /// Ends an open job. @return false if it has ended, or a run of it waits or is under way
  bool finish(std::int64_t job, JobState state, const std::string& message);
  /// Dismisses a job in any state and deletes its runs, so no claim on them is current any more.
  void dismiss(std::int64_t job);
  /// Returns up to `most` unused pages to the file system, if there are more than a few. @return whether more are left
  bool shrink(std::int64_t most);
  /// At start: queues runs again whose record does not agree with its checksum, and recounts the runs of jobs whose
  /// counts are wrong. Reads every run once. @return what was damaged
  std::vector<std::string> repair_rows();
  /// Makes what submission fixed of a job that of `right`. @return false where it is
  bool restore(const Job& job, const NewJob& right);
  /// Requeues runs that are done, since their results are lost, and opens the job again.
  void requeue_lost(std::int64_t job, std::span<const RunKey> lost);
  /// Requeues the failed runs. @return how many
  std::int64_t retry_failed(std::int64_t job, const Response& response = {});
  /// Adds realizations up to `planned` in all, unless the job has been dismissed.
  /// @return false where another request has used the key meanwhile
  bool extend(std::int64_t job, std::int64_t planned, const Response& response = {});
  std::optional<StoredResponse> stored_response(const std::string& subject, const std::string& key);
  /// Running jobs all of whose runs have ended.
  std::vector<Job> complete_jobs();
  /// Open jobs of a process that has no runs.
  std::vector<Job> open_jobs_without_runs(const std::string& process);

  // Runs, for the engine.

  /// Leases the next run: of the open job with the fewest runs under way; ties go to the least recently served.
  std::optional<Claim> claim() override;
  StudyInfo study(StudyNumber number) override;
  void visit_records(StudyNumber number, const Visitor& visit) override;
  bool is_current(const Claim& claim) override;
  bool accept(const Claim& claim, const Record& record) override;
  bool fail(const Claim& claim, const Failure& failure) override;
  bool give_back(const Claim& claim, bool crashed) override;
  std::vector<std::size_t> renew(std::span<const Claim> held) override { return renew_leases(held).lost; }
  void drop_open_runs(StudyNumber number, bool replicates_too) override;
  void abort(StudyNumber number, bool bad_case, const std::string& why) override;

  struct Renewal {
    std::vector<std::size_t> lost;  ///< positions of claims that are not current any more
    std::int64_t requeued = 0;
  };
  /// Renews the leases of `held` and requeues the expired ones in one transaction: after a jump of the clock every
  /// other lease looks expired or, with the clock set back, as if it had been given in the future.
  Renewal renew_leases(std::span<const Claim> held);
  /// Requeues every leased run: at start, when no worker can be alive. @return how many
  std::int64_t requeue_all();

  // Runs, for requests and statistics.

  std::vector<Run> runs(std::int64_t job, const RunFilter& filter);
  std::optional<Run> run(std::int64_t job, const RunKey& key);
  /// The runs of one kind that have ended, in order of index; one is held at a time.
  RecordSource records(std::int64_t job, RunKind kind);
  /// The values of one measure over the realizations that count.
  /// @param stop_half_width  of the job's plan: the study is cut where StopRule says so
  MeasureSample measure_sample(const Job& job, const Measure& measure, const std::optional<double>& stop_half_width);

 private:
  Database db_;
  std::filesystem::path jobs_;
  Clock clock_;
  Milliseconds lease_;
};

}  // namespace talus::service
