#pragma once
// The store of one study in its directory: a realization is finished once its result stands in runs/, by rename, and
// never before. Opening reads every record once, in time and memory linear in their number.

#include <deque>
#include <map>

#include "study/store.hpp"

namespace talus {

/// Which runs belong to the study of a plan.
StudyIdentity identity(const Plan& plan);

/// Records by index.
using Records = std::map<std::int64_t, Record>;

/// The records of one kind in a study directory; writes nothing. A result that cannot be read counts as not there.
/// @throws ForeignResult, IoError
Records read_records(const StudyPaths& paths, RunKind kind, const StudyIdentity& identity);

class DirectoryStore final : public Store {
 public:
  /// @param first, end  the realizations to run here; the replicates go with realization 0
  /// @throws ForeignResult, IoError
  DirectoryStore(StudyPaths paths, const Plan& plan, std::int64_t first, std::int64_t end);

  const Records& records(RunKind kind) const { return kind == RunKind::replicate ? replicates_ : runs_; }
  /// Removes all failure records, so that those runs are carried out again.
  void forget_failures();
  /// Removes the results of the realizations whose kept profile is damaged and that are run here, so that they are
  /// carried out again. @return their indices
  std::vector<std::int64_t> forget_damaged_profiles();

  std::optional<Claim> claim() override;
  StudyInfo study(StudyNumber) override { return info_; }
  void visit_records(StudyNumber, const Visitor& visit) override;
  bool is_current(const Claim& claim) override;
  bool accept(const Claim& claim, const Record& record) override;
  bool fail(const Claim& claim, const Failure& failure) override;
  bool give_back(const Claim& claim, bool crashed) override;
  std::vector<std::size_t> renew(std::span<const Claim>) override { return {}; }  // the directory is locked
  void drop_open_runs(StudyNumber, bool replicates_too) override;
  [[noreturn]] void abort(StudyNumber, bool bad_case, const std::string& why) override;

 private:
  Records& records(RunKind kind) { return kind == RunKind::replicate ? replicates_ : runs_; }
  bool runs_here(const RunKey& key) const;
  bool end_claim(const Claim& claim);

  StudyInfo info_;
  Records runs_, replicates_;
  std::int64_t rank_ = 0;       ///< of the first run that has not been considered yet
  std::deque<Claim> returned_;  ///< given back; claimed before those
  std::map<RunKey, std::int64_t> claimed_;
  bool dropped_realizations_ = false, dropped_replicates_ = false;
};

}  // namespace talus
