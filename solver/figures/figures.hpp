#pragma once
// Figures of a finished study or run, from its files alone. Thread-safe for different directories.

#include <filesystem>
#include <vector>

namespace talus {

/// Draws a study's charts and the profiles of its first and its worst run to DIR/figures/*.svg and *.png, from
/// study.json, realizations.csv, case.resolved.json and profiles/{first,worst}.vtkhdf. What has no file (a merged study
/// keeps no profiles) is left out.
/// @return the files drawn
/// @throws IoError when gnuplot is missing ("install gnuplot-nox"), a file is missing or damaged, or no realization is
/// done
std::vector<std::filesystem::path> plot_study(const std::filesystem::path& directory);

/// Draws a run's profiles at its snapshot times to DIR/figures/, from snapshots.vtkhdf, result.json and
/// case.resolved.json.
/// @return the files drawn
/// @throws IoError as plot_study
std::vector<std::filesystem::path> plot_run(const std::filesystem::path& directory);

}  // namespace talus
