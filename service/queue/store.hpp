#pragma once
// The queue. All SQL of the service is in this module.

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "queue/database.hpp"
#include "queue/records.hpp"
#include "study/record.hpp"
#include "study/store.hpp"
#include "study/summary.hpp"

namespace talus::service {

/// Thread-safe.
class Store final : public talus::Store {
 public:
  /// @param jobs   where the directories of the jobs are
  /// @param lease  how long a claim holds without being renewed
  /// @throws StorageError
  Store(const std::filesystem::path& path, std::filesystem::path jobs, Clock clock, Milliseconds lease)
      : db_(path), jobs_(std::move(jobs)), clock_(std::move(clock)), lease_(lease) {}

  // --- jobs
  // -----------------------------------------------------------------------------------------------------------

  /// Records a job and its runs; durable when this returns.
  /// @param answer  what its owner was told under an Idempotency-Key, in the same transaction: made from the job
  /// @return its row; nothing where the key has been used meanwhile
  using Answer = std::function<Remembered(const Job&)>;
  std::optional<Job> create(const NewJob& job, const Answer& answer = {});
  std::optional<Job> job(const std::string& id);
  std::optional<Job> job(std::int64_t number);
  std::vector<Job> jobs(const JobFilter& filter);
  /// Jobs that are accepted or running, of one subject or of all.
  std::int64_t open_jobs(const std::optional<std::string>& subject);
  /// Ids of the jobs that are not dismissed.
  std::set<std::string> known_ids();
  std::set<std::string> dismissed_ids();
  Census census();

  /// Writes down why no run of an open job is under way; empty: nothing is known.
  void note_waits(std::int64_t job, const std::string& why);
  /// Ends a job that has not ended yet and of which nothing is queued or leased.
  bool finish(std::int64_t job, JobState state, const std::string& message);
  /// Makes a job dismissed whatever it was; its runs are forgotten, so nobody's attempt is current any more.
  void dismiss(std::int64_t job);
  /// Puts the failed realizations (not the done ones) back into the queue. @return how many
  std::int64_t retry_failed(std::int64_t job, const Answer& answer = {});
  /// Adds realizations up to `planned` in all, unless the job has been dismissed. @return false where the key has been
  /// used meanwhile
  bool extend(std::int64_t job, std::int64_t planned, const Answer& answer = {});
  std::optional<Remembered> remembered(const std::string& subject, const std::string& key);

  // --- runs, for the engine
  // ----------------------------------------------------------------------------------------

  /// Leases the next run: of the open job with the fewest runs under way; of equals, the one served longest ago.
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
  /// Renews the leases of `held` and requeues the expired ones, at one moment: after a jump of the clock every other
  /// lease looks expired, or, set back, as if it had been given in the future.
  Renewal renew_leases(std::span<const Claim> held);
  /// Puts back every leased run: at start, when no worker can be alive.
  /// @return how many
  std::int64_t requeue_all();
  /// Jobs all of whose runs have ended but which have not.
  std::vector<Job> complete_jobs();
  /// Jobs of a process that have no runs and have not ended.
  std::vector<Job> waiting_jobs(const std::string& process);
  bool start(std::int64_t job);
  bool is_open(std::int64_t job);

  // --- runs, for readers
  // ----------------------------------------------------------------------------------------------

  std::vector<Run> runs(std::int64_t job, const RunFilter& filter);
  std::optional<Run> run(std::int64_t job, const RunKey& key);

  // --- records, for statistics

  /// Gives every run that has ended, of one kind, in order of index; one row is held at a time.
  void for_each_record(std::int64_t job, bool floor, const std::function<void(const Record&)>& take);
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
