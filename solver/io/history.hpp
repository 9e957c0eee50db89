#pragma once
// history.csv: the course of a run, a line per recorded step.

#include <filesystem>
#include <span>
#include <vector>

#include "simulation/run_result.hpp"

namespace talus {

/// Writes all rows atomically: columns time_s, step, front_m, centre_of_mass_x_m, kinetic_energy_J_per_m,
/// max_speed_m_s; then energy_terms and created_J_m.
/// @throws IoError naming the path; an older file is then untouched
void write_history(const std::filesystem::path& path, std::span<const HistoryRow> rows);

/// Reads them back, bit for bit; a resumed run continues from these. A file of an earlier version, with six columns,
/// has no energy.
/// @throws IoError naming the path and the line
std::vector<HistoryRow> read_history(const std::filesystem::path& path);

}  // namespace talus
