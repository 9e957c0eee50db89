#pragma once
// What a realization of a case draws, for the plan of a study.

#include <vector>

#include "case/load.hpp"
#include "study/plan.hpp"

namespace talus {

/// The numbers behind a realization, a block for each property, in the order of xi. Coefficients of a Karhunen-Loeve
/// field come by falling variance; those of circulant embedding have no such order, and a count of 0. Errors of data
/// and the nugget are left out. Empty where nothing is random.
/// @throws ConfigError when the field cannot be built
std::vector<DrawnNumbers> drawn_numbers(const Case& problem);

/// Completes a plan of a version that did not write down what is drawn, from the case that it is of.
/// @throws ConfigError when the field cannot be built
void add_missing_draws(Plan& plan, const LoadedCase& loaded);

}  // namespace talus
