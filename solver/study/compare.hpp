#pragma once
// Two studies on the same draws: what a change of the case does, judged pair by pair.

#include <string>
#include <vector>

#include "study/publish.hpp"
#include "support/json.hpp"

namespace talus {

/// JSON pointers of the values in which two documents differ; of lists of another size the list itself.
std::vector<std::string> differences(const Json& a, const Json& b);

/// The comparison of B with A: {pairs, only_in_a, only_in_b, failed, case_differences, quantities, targets}.
/// Realization i of both has the same random numbers, so what they share cancels in the differences.
/// @param case_a, case_b  the resolved cases
/// @throws ConfigError naming what makes their draws differ: seed, sampling, random field, or the slide whose bounding
/// box is the field's domain
Json comparison(const Tables& a, const Tables& b, const Json& case_a, const Json& case_b);

/// The comparison as a table for people.
std::string comparison_text(const Json& comparison);

}  // namespace talus
