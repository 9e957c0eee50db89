#pragma once
// What the verdicts of the runs say of a study.

#include <cstdint>
#include <map>
#include <string>

#include "statistics/sample.hpp"
#include "study/record.hpp"
#include "support/json.hpp"

namespace talus {

/// Realizations by verdict. Invalid ones have failed; failed ones without a result are in none of these.
struct QualityCounts {
  std::int64_t sound = 0, doubtful = 0, invalid = 0, not_assessed = 0;

  void add(const Record& record);
  Json json() const;
  bool operator==(const QualityCounts&) const = default;
};

/// Numerical noise whose standard deviation is above this share of that of the realizations makes a study doubtful: at
/// a third, noise is a ninth of the variance, and widens the spread by 6 %.
inline constexpr double most_noise = 1.0 / 3.0;

/// Takes in the records of a study one by one. Holds one message for each check.
class QualitySummary {
 public:
  void add(const Record& record);
  const QualityCounts& counts() const { return counts_; }

  /// `quality` of study.json: verdict, counts, and for each check that objected the number of runs and one message.
  /// @param runout, noise  moments of the run-out distance over the realizations, and over the noise-floor replicates
  Json json(const SampleMoments& runout, const SampleMoments& noise) const;

 private:
  struct Objections {
    std::int64_t runs = 0;
    std::string example;  ///< message of the first run
  };
  QualityCounts counts_;
  std::map<std::string, Objections> objections_;  ///< by check
};

/// "12 of 20 runs doubtful, 2 invalid: 12 still moving, 2 particles in ground" from `quality` of study.json; empty
/// where there is nothing to say.
std::string quality_line(const Json& quality);

}  // namespace talus
