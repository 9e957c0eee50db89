#pragma once
// What figures need from a study's directory: study.json and realizations.csv.

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "statistics/histogram.hpp"
#include "statistics/proportion.hpp"
#include "statistics/sample.hpp"

namespace talus::figures {

/// One measure of a study. [m]
struct Quantity {
  std::optional<double> mean;
  std::optional<Interval> mean_ci95;
  std::optional<double> stdev;
  std::optional<Interval> stdev_ci95;
  Histogram histogram;                 ///< no edges where nothing was done
  std::vector<Exceedance> exceedance;  ///< in order of x
  std::optional<double> noise_floor_stdev;
  std::map<double, double> quantiles;  ///< value at probability
  std::int64_t censored = 0;           ///< runs whose soil left the terrain
  double censored_from = 0.0;          ///< the least run-out of them [m]
};

/// A finished realization.
struct Done {
  std::int64_t index;
  double influence_zone;     ///< [m]
  double mean_phi_deg;       ///< [deg]
  bool lower_bound = false;  ///< soil left the terrain: it may have gone farther
};

/// A study as its files tell it.
struct StudyFiles {
  std::string title;
  std::string source;  ///< version, seed, case, for the source line
  std::int64_t planned = 0;
  std::int64_t done = 0;
  std::int64_t failed = 0;
  std::string quality;                         ///< quality_line() of the study; empty where there is nothing to say
  std::map<std::string, Quantity> quantities;  ///< by key: "influence_zone_m"
  std::vector<Done> realizations;              ///< in order of index
  std::map<std::string, Proportion> reached;   ///< of each target, by its name

  const Quantity& runout() const { return quantities.at("influence_zone_m"); }
};

/// Reads DIR/study.json and DIR/realizations.csv.
/// @throws IoError naming the file and what it lacks
StudyFiles read_study(const std::filesystem::path& directory);

}  // namespace talus::figures
