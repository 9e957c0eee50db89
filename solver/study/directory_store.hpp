#pragma once
// The store of one study in its directory: a realization is finished once its result stands in runs/, by rename, and
// never before. Opening reads every record once, in time and memory linear in their number.

#include <deque>
#include <map>
#include <vector>

#include "study/store.hpp"

namespace talus {

/// The records of one kind in a study directory, in order of index; writes nothing. A result that cannot be read counts
/// as not there.
/// @throws ForeignResult, IoError
std::vector<Record> read_records(const StudyPaths& paths, RunKind kind, const StudyIdentity& identity);

class DirectoryStore final : public Store {
 public:
  /// @param first, end  the realizations to run here; the replicates go with realization 0
  /// @throws ForeignResult, IoError
  DirectoryStore(StudyPaths paths, const Plan& plan, std::int64_t first, std::int64_t end);

  /// In order of index. Valid until the next change.
  const std::vector<Record>& runs() { return runs_.in_order(); }
  const std::vector<Record>& replicates() { return replicates_.in_order(); }
  /// Removes all failure records, so that those runs are carried out again.
  void forget_failures();

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
  /// Records in order of index; those added since the last look apart, so that adding one is not linear.
  class Records {
   public:
    void assign(std::vector<Record> records) { old_ = std::move(records); }
    bool contains(std::int64_t index) const;
    void add(Record record) { new_.insert_or_assign(record.index, std::move(record)); }
    const std::vector<Record>& in_order();

   private:
    std::vector<Record> old_;
    std::map<std::int64_t, Record> new_;
  };

  Records& records(const RunKey& key) { return key.is_replicate() ? replicates_ : runs_; }
  bool runs_here(const RunKey& key) const;
  bool end_claim(const Claim& claim);

  StudyInfo info_;
  Records runs_, replicates_;
  std::int64_t rank_ = 0;       ///< of the first run not looked at yet
  std::deque<Claim> returned_;  ///< given back, before those
  std::map<RunKey, std::int64_t> claimed_;
  bool dropped_realizations_ = false, dropped_replicates_ = false;
};

}  // namespace talus
