#pragma once
// Where the runs of studies and their records are kept. Two implementations: DirectoryStore (the files of one study),
// and the SQLite queue of talusd (many studies).

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "study/estimator.hpp"
#include "study/outcome.hpp"
#include "study/plan.hpp"
#include "study/record.hpp"

namespace talus {

using StudyNumber = std::int64_t;  ///< of a study in its store

/// A run handed to a worker. Only the holder of the current attempt may say how it ended.
struct Claim {
  StudyNumber study = 0;
  RunKey key;
  std::int64_t attempt = 1;  ///< grows with every claim
  int crashes = 0;           ///< attempts that ended without a result, counted against the run
};

/// A study as the engine needs to know it.
struct StudyInfo {
  std::string name;  ///< unique in the store; empty where there is only one
  StudyPaths paths;
  StudyIdentity identity;
  StudySpec spec;
  std::int64_t first = 0, end = 0;  ///< realizations first <= i < end are run here
};

/// To be used by one engine. Every function throws IoError or StorageError where the store cannot be read or written;
/// nothing has changed then.
class Store {
 public:
  using Visitor = std::function<void(const RunKey&, std::optional<double> influence_zone)>;

  virtual ~Store() = default;
  /// Takes the next run, in the order of the estimator; nothing where none waits.
  virtual std::optional<Claim> claim() = 0;
  /// The study of a claim.
  virtual StudyInfo study(StudyNumber number) = 0;
  /// Visits every record of a study, in any order; a failed run has no influence zone.
  virtual void visit_records(StudyNumber number, const Visitor& visit) = 0;
  /// Whether the claim's attempt is still the current one.
  virtual bool is_current(const Claim& claim) = 0;
  /// Each of the next three: false, and nothing changes, unless the claim is current.
  virtual bool accept(const Claim& claim, const Record& record) = 0;
  virtual bool fail(const Claim& claim, const Failure& failure) = 0;
  /// Puts a run back. @param crashed  it counts against the run
  virtual bool give_back(const Claim& claim, bool crashed) = 0;
  /// Keeps the claims of a live engine from running out. @return positions of those that are not current any more
  virtual std::vector<std::size_t> renew(std::span<const Claim> held) = 0;
  /// Drops the runs of a study that wait or are under way. @param replicates_too  otherwise only the realizations
  virtual void drop_open_runs(StudyNumber number, bool replicates_too) = 0;
  /// The study cannot go on. @param bad_case  the case is at fault, not the machine
  /// @throws ConfigError, IoError where the front end ends with its only study
  virtual void abort(StudyNumber number, bool bad_case, const std::string& why) = 0;
};

}  // namespace talus
