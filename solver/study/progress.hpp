#pragma once
// What a person sees while a study runs, and at its end. Makes text; prints nothing.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace talus {

/// Where a study stands.
struct Progress {
  std::int64_t planned = 0;  ///< realizations to be run here
  std::int64_t done = 0;
  std::int64_t failed = 0;
  std::int64_t floor_planned = 0;  ///< noise-floor replicates
  std::int64_t floor_made = 0;     ///< done or failed
  std::int64_t made_now = 0;       ///< runs ended since this process began
  int running = 0;
  double elapsed = 0.0;                        ///< since this process began [s]
  std::optional<double> mean = {};             ///< influence zone [m]
  std::optional<double> mean_half_width = {};  ///< of its 95 % interval [m]
  std::string pending_reason = {};             ///< why no run is under way, where that is known
};

/// Time to go at the present rate [s]; unset before the first run has ended.
std::optional<double> time_left(const Progress& progress);

/// "12/100 done, 1 failed, 4 running, 240/h, 22 min left, mean 34.12 +/- 0.31 m"
std::string progress_line(const Progress& progress);

/// The same behind a bar, cut to `width` columns.
std::string progress_bar(const Progress& progress, int width);

/// The table that ends a study, from the content of study.json.
std::string summary_table(const nlohmann::ordered_json& study);

/// The histogram of a quantity as bars of text, `width` columns in all; empty where there is none.
std::string text_histogram(const nlohmann::ordered_json& quantity, int width);

}  // namespace talus
