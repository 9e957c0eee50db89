#pragma once
// targets.csv: the course of a run at its targets, a line per recorded step and target.

#include <filesystem>
#include <span>
#include <vector>

#include "simulation/target.hpp"
#include "simulation/target_gauges.hpp"

namespace talus {

/// Writes all rows atomically: columns time_s, step, target (its name), depth_m, speed_m_s, dynamic_pressure_Pa; then,
/// empty where the target is no structure, horizontal_force_N_m, downward_force_N_m and overturning_moment_Nm_m, means
/// since the row before of the same target, and the same integrated over time since the start of the run.
/// @param rows  in order of time; those of a step in the order of the targets
/// @throws IoError naming the path; an older file is then untouched
void write_target_history(const std::filesystem::path& path, std::span<const Target> targets,
                          std::span<const TargetRow> rows);

/// Reads them back, bit for bit; a resumed run continues from these.
/// @throws IoError naming the path and the line
std::vector<TargetRow> read_target_history(const std::filesystem::path& path, std::span<const Target> targets);

}  // namespace talus
