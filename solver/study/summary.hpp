#pragma once
// study.json: everything a study says, from its plan and its records alone.

#include <nlohmann/json.hpp>
#include <vector>

#include "study/plan.hpp"
#include "study/record.hpp"

namespace talus {

/// The content of study.json (schemas/study.schema.json). A pure function: a study and `talus stats` on its tables give
/// the same.
/// @param runs   in order of index; at most one per realization
/// @param floor  replicates of realization 0 that differ by rounding-size changes only, in order
nlohmann::ordered_json summarize(const Plan& plan, const std::vector<Record>& runs, const std::vector<Record>& floor);

/// More realizations failed than `plan.study.max_failed_share` of those made.
bool too_many_failed(const Plan& plan, const std::vector<Record>& runs);

}  // namespace talus
