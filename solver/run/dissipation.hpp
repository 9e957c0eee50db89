#pragma once
// Whether the dissipation that a case states, or the numerical one, decides how far its slide runs.

#include <vector>

#include "case/load.hpp"

namespace talus {

/// Does a material with strength come to rest by the elastic law without a viscosity and without mu(I) friction? Its
/// run-out then depends on the numerical dissipation. Fluids without strength are left alone.
bool lacks_rate_dependence(const Model& model);

/// Warnings about the rate dependence of the materials: none is stated, it is less than that of the artificial
/// viscosity, or its grains are larger than the particles. Each with the pointer to the material's section.
std::vector<Fault> dissipation_warnings(const Model& model);

}  // namespace talus
