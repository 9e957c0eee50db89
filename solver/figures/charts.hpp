#pragma once
// The charts of a study, each one sheet.

#include <span>

#include "figures/sheet.hpp"
#include "figures/study_files.hpp"
#include "particles/geometry_input.hpp"
#include "simulation/target.hpp"

namespace talus::figures {

/// Histogram of the farthest particle's run-out distance, the paper's influence zone; beneath it, on the same scale,
/// the interval of the mean, the standard deviation and the numerical noise.
Sheet histogram_sheet(const StudyFiles& study);

/// Probability that the farthest particle of a run goes beyond x, with Wilson's 95 % band.
Sheet exceedance_sheet(const StudyFiles& study);

/// Mean run-out distance of the farthest particle over the first n realizations done and its 95 % interval against n.
Sheet running_mean_sheet(const StudyFiles& study);

/// Probability that the farthest particle reaches x, a step at the front of each run, above the terrain with the slide
/// before its release; ahead of the slide's toe only, and beyond the last front, where it is 0 with its upper bound.
/// Targets are drawn in, each with the probability that it is reached.
/// @param structures  outlines, as structures_of() gives them
Sheet hit_probability_sheet(const StudyFiles& study, const Terrain& terrain, std::span<const SlidePart> slide,
                            std::span<const Target> targets = {}, const std::vector<Polyline>& structures = {});

/// Run-out distance of the farthest particle against the spatial mean of the friction angle, one point a realization.
Sheet friction_angle_sheet(const StudyFiles& study);

/// Standard deviation of every measure beside its numerical noise.
Sheet spread_sheet(const StudyFiles& study);

/// An empty chart: the study's title, `subtitle`, what makes it doubtful, its source and its number of realizations.
Sheet chart(const StudyFiles& study, std::string_view subtitle, const Canvas& canvas = {900, 576});

/// "200 realizations" or "198 of 200 realizations done, 2 failed".
std::string count_text(const StudyFiles& study);

/// What a subtitle says of runs whose soil left the terrain; empty without any.
std::string censored_text(const Quantity& q);
/// What subtitles begin with: "Mean: 99 % of the mass 30.11 m, farthest particle 34.12 [33.98, 34.26] m", the leading
/// measure beside the one that is drawn; "at least" where soil left the terrain.
std::string means_text(const StudyFiles& study);
/// "34.12 [33.98, 34.26] m"; "unknown", or without the interval, where the sample is too small.
std::string interval_text(const std::optional<double>& value, const std::optional<Interval>& interval);

}  // namespace talus::figures
