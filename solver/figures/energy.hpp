#pragma once
// The energy balance of a run over time, one sheet.

#include <span>

#include "figures/sheet.hpp"
#include "simulation/run_result.hpp"

namespace talus::figures {

/// Work of gravity and the terms that took it, as lines over time; terms that stay below 0.5 % of it are only listed.
/// @param history  at least one row
Sheet energy_sheet(std::span<const HistoryRow> history, const Stamps& stamps);

}  // namespace talus::figures
