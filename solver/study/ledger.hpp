#pragma once
// The books of a study on disk: a realization is finished once its result stands in runs/, by rename, and never before.

#include <cstdint>
#include <vector>

#include "study/paths.hpp"
#include "study/plan.hpp"
#include "study/record.hpp"

namespace talus {

/// Why a run gave no result.
struct Failure {
  std::string reason;  ///< one line
  int exit_code = 0;
  int signal = 0;  ///< 0: it left by itself
  int attempts = 1;
  std::string log_tail;
  std::string rerun;  ///< command that repeats it
};

class Ledger {
 public:
  /// Reads what earlier processes have finished, and writes nothing; a result that cannot be read counts as not there.
  /// @throws IoError when a result belongs to another study, or a directory cannot be read
  Ledger(StudyPaths paths, const Plan& plan);

  /// Makes the directories that runs and commits need.
  /// @throws IoError
  void make_directories() const;

  const std::vector<Record>& runs() const { return runs_; }    ///< in order of index
  const std::vector<Record>& floor() const { return floor_; }  ///< in order of k
  bool has(Job job) const;

  /// Whether the working directory of a job holds the result of a run that came to its end.
  /// @throws IoError when it is the result of something else
  bool finished_in_work(Job job) const;
  /// Moves the result from the working directory to its place, keeps the first and the farthest profile, removes the
  /// rest.
  void commit(Job job);
  /// Records that a job failed.
  void commit_failure(Job job, const Failure& failure);
  /// Takes all failed jobs out of the books, so that they are run again.
  void forget_failures();

 private:
  void scan(bool floor);
  std::optional<Record> read(Job job, const std::filesystem::path& file) const;
  void keep_profiles(const Record& record);
  std::vector<Record>& records(Job job) { return job.floor ? floor_ : runs_; }

  StudyPaths paths_;
  std::uint64_t seed_;
  std::string case_hash_;
  std::vector<Record> runs_;
  std::vector<Record> floor_;
};

}  // namespace talus
