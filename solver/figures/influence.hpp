#pragma once
// Which soil moves the front: the influence of each random field on the section.

#include <filesystem>
#include <vector>

#include "case/load.hpp"
#include "figures/study_files.hpp"
#include "study/publish.hpp"

namespace talus::figures {

/// The slide as a picture, or one picture for each property that is a field, coloured by what the front of 99 % of the
/// mass changes with the property there (run/influence.hpp); white where the 95 % interval includes 0. Captions state
/// the share of the variance of each property. Drawn to .svg and .png.
/// @param name  path without ending
/// @return the files; none where the study has no regression, or no property is a field
/// @throws IoError as plot_study
std::vector<std::filesystem::path> plot_influence(const StudyFiles& study, Tables tables, const LoadedCase& of,
                                                  const std::filesystem::path& name);

}  // namespace talus::figures
