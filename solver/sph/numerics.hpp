#pragma once
// Options of the method; the recommended value of each is listed first.

#include <optional>

namespace talus {

enum class WallContact { always, approaching };  ///< approaching: a wall acts only where v_ij . x_ij < 0, [Z20] 2.1
enum class KernelShape { wendland_c2, cubic_spline };
enum class DensityFilter { delta_sph, shepard, none };
enum class VelocityJump { whole, reconstructed };  ///< what the artificial viscosity acts on, see momentum-inl.hpp
enum class Integrator { rk2, leapfrog };
enum class Continuity { volume, mass };  ///< rho_i sum V_j | sum m_j, [Z20] Eq. 1; equal where density is uniform
enum class Precision { single, full };   ///< of the soil-soil pair sums; the state is double in both
enum class InitialPressure { hydrostatic, stress_free };

/// How the equations are discretised.
struct Numerics {
  /// Wendland's kernel keeps particles from pairing and allows a wide support; with it replicate runs stay together at
  /// fine spacings too: on the illustrative slope at dx = 0.1 m the front's noise is 4.5 mm, against 32 mm with the
  /// cubic spline and h = 1.2 dx.
  KernelShape kernel = KernelShape::wendland_c2;
  double h_over_dx = 1.5;     ///< smoothing length over particle spacing [-], in [1, 2]
  std::optional<double> c_s;  ///< speed of sound [m/s], > 0; unset: 10 sqrt(2 g H)
  double alpha = 0.1;         ///< artificial viscosity, linear term [-], >= 0
  VelocityJump velocity_jump =
      VelocityJump::reconstructed;  ///< of two particles, that the artificial viscosity acts on
  double beta = 0.0;                ///< artificial viscosity, quadratic term [-], >= 0
  Continuity continuity = Continuity::volume;
  /// The diffusion leaves a resting pile alone and keeps replicate runs together: on the illustrative slope at dx = 0.4
  /// m a change of tan(phi) by 1e-6 moves the front by 6e-5 m with it and by 0.018 m with the Shepard filter.
  DensityFilter density_filter = DensityFilter::delta_sph;
  int filter_interval = 30;    ///< steps between two Shepard filters, >= 1
  double delta = 0.1;          ///< coefficient of the delta-SPH diffusion [-], >= 0
  bool tension_cutoff = true;  ///< negative pressure is cut to zero
  InitialPressure initial_pressure = InitialPressure::hydrostatic;
  Integrator integrator = Integrator::rk2;
  Precision precision = Precision::single;
  double cfl = 0.4;  ///< Courant number [-], in (0, 1]
  bool operator==(const Numerics&) const = default;
};

/// What all walls have in common; how soil slides along them is a matter of each Boundary.
struct Walls {
  WallContact contact = WallContact::always;
  double b_max = 1.5;  ///< largest ratio of mirrored velocity [-], >= 1; [Morris 1997] 1.5
  int layers = 3;      ///< layers of wall particles, enough to fill the support 2h
  bool operator==(const Walls&) const = default;
};

}  // namespace talus
