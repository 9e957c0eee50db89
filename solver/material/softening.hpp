#pragma once
// Loss of strength with plastic shear strain, from peak to residual.

#include <algorithm>

namespace talus {

/// How far a soil has softened: gamma_p over the strain at which it is residual, at most 1 [-].
/// @param gamma_p   plastic shear strain, accumulated [-], >= 0
/// @param gamma_r   plastic shear strain at which the strength is residual [-], > 0
inline double softened_share(double gamma_p, double gamma_r) { return std::min(gamma_p / gamma_r, 1.0); }

/// Strength falls linearly from the peak to the residual value, which is at most the peak: peak - (peak - residual) s.
/// @param share  softened_share [-]
inline double softened(double peak, double residual, double share) {
  return peak - std::max(peak - residual, 0.0) * share;
}

/// gamma_r = displacement / width: a shear band of that width, sheared evenly, has lost its strength at this
/// displacement of its two sides. With a width that goes with the spacing, the work that a metre of band takes does not
/// depend on the spacing (crack band model: Bazant & Oh 1983, Materials and Structures 16). [-]
inline double residual_strain(double displacement, double width) { return displacement / width; }

/// Plastic shear strain of a return to the yield surface: the excess of the elastic shear stress over the shear
/// modulus. [-]
/// @param size   sqrt(t:t/2) of the elastic deviator before the return [Pa]
/// @param limit  yield stress [Pa]
/// @param G      shear modulus [Pa], > 0
inline double plastic_increment(double size, double limit, double G) { return std::max(size - limit, 0.0) / G; }

}  // namespace talus
