// How a fixed wall particle acts on the soil: its virtual velocity and its extrapolated stress. For every number type;
// included once for every instruction set.

#if defined(TALUS_SPH_WALL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TALUS_SPH_WALL_INL
#undef TALUS_SPH_WALL_INL
#else
#define TALUS_SPH_WALL_INL
#endif

#include <hwy/highway.h>

#include <algorithm>

#include "material/constitutive_models-inl.hpp"
#include "math/tensor-inl.hpp"
#include "sph/flow_constants.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {

/// b = min(b_max, 1 + d_j/d_i): the velocity mirrored about the wall line over the soil's own.
/// Takeda 1994, Morris 1997 (b_max = 1.5). d_i: soil to wall line, d_j: wall particle to wall line, both [m].
template <class Real>
HWY_INLINE Real mirror_ratio(Real d_i, Real d_j, Real b_max) {
  const Real gap = max(d_i, Real(1e-6) * d_j);  // a particle on the line, or through it, gets b_max
  return min(b_max, Real(1.0) + d_j / gap);
}

/// v_ij of a soil-wall pair: b v_i for a rough wall; only its normal part for a smooth one.
template <class Real>
HWY_INLINE Vector<Real> wall_relative_velocity(Vector<Real> v_i, Vector<Real> n, Real b, bool smooth) {
  return smooth ? (b * dot(v_i, n)) * n : b * v_i;
}

/// A wall particle as a soil particle sees it.
template <class Real>
struct WallParticle {
  Vector<Real> normal;  ///< unit normal of the wall, towards the soil
  Real depth;           ///< distance to the wall line [m]
  bool smooth;          ///< its boundary has WallSlip::free_slip
};

/// A soil-wall pair.
template <class Real>
struct WallPair {
  Real distance;      ///< of the soil particle to the wall line, by the tangent at the wall particle's foot [m]
  Vector<Real> v_ij;  ///< relative velocity [m/s]
  Real v_dot_r;       ///< [m/s times the unit of the distances]
};

/// A wall that is weaker than the soil is a thin interface layer with the wall's strength (after Desai 1984): soil in
/// it yields at the smaller cohesion and at the smaller friction angle of both. Where several such walls are near, the
/// smallest count.
/// @param within  the soil is nearer to the wall line than the layer is thick
template <class Real, class Mask>
HWY_INLINE MohrCoulomb<Real> interface_strength(MohrCoulomb<Real> soil, MohrCoulomb<Real> wall, Mask within) {
  return {select(within, min(soil.c, wall.c), soil.c), select(within, min(soil.tan_phi, wall.tan_phi), soil.tan_phi)};
}
/// The weaker of both by the stress at which it yields under the pressure p: c + p tan(phi) of the result is the
/// smaller one of the two, whatever their terms (FlowConstants: has_turbulent_walls).
template <class Real>
HWY_INLINE MohrCoulomb<Real> weaker_strength(MohrCoulomb<Real> soil, MohrCoulomb<Real> wall, Real p) {
  const Real tan_phi = min(soil.tan_phi, wall.tan_phi), bearing = max(p, Real(0.0));
  return {min(fma(bearing, soil.tan_phi - tan_phi, soil.c), fma(bearing, wall.tan_phi - tan_phi, wall.c)), tan_phi};
}
/// [m]; wide enough to hold most of what the kernel sees from the wall: one row of particles at h = 1.2 dx, two at 1.5
/// dx.
inline double interface_thickness(double h) { return 1.1 * h; }

/// What all walls of a run have in common.
template <class Real>
struct WallLaw {
  Real b_max;  ///< largest mirror ratio [-]
  Real unit;   ///< of the distances [m]
  bool only_approaching;
  bool frictional;  ///< a boundary has a strength of its own
  bool turbulent;   ///< a boundary has a turbulence coefficient
  Real thickness;   ///< of the interface layer [m]

  /// @param metres  unit of the distances [m]
  HWY_INLINE WallLaw(const FlowConstants& k, double metres)
      : b_max(k.walls.b_max),
        unit(metres),
        only_approaching(k.walls.contact == WallContact::approaching),
        frictional(
            std::ranges::any_of(k.boundaries, [](const WallFriction& b) { return b.slip == WallSlip::friction; })),
        turbulent(has_turbulent_walls(k.boundaries)),
        thickness(interface_thickness(k.h)) {}

  /// Strength of soil near a wall particle. @param p  pressure of the soil [Pa], used with a turbulence coefficient
  template <class Mask>
  HWY_INLINE MohrCoulomb<Real> strength(MohrCoulomb<Real> soil, MohrCoulomb<Real> wall, Real p, Mask within) const {
    if (!turbulent) return interface_strength(soil, wall, within);
    const MohrCoulomb<Real> weaker = weaker_strength(soil, wall, p);
    return {select(within, weaker.c, soil.c), select(within, weaker.tan_phi, soil.tan_phi)};
  }

  HWY_INLINE WallPair<Real> pair(Vector<Real> r_ij, Vector<Real> v_i, const WallParticle<Real>& j) const {
    const Real distance = fms(unit, dot(r_ij, j.normal), j.depth);
    const Real b = mirror_ratio(distance, j.depth, b_max);
    const Vector<Real> v_ij = wall_relative_velocity(v_i, j.normal, b, j.smooth);
    return {distance, v_ij, dot(v_ij, r_ij)};
  }
};

/// The most that pressure and deviatoric stress may grow on their way to a wall particle [-]: that of a single row of
/// soil.
inline constexpr double max_stress_growth = 6.0;

/// By how much the soil's deviatoric stress grows on its way to a wall particle. Under its own weight a layer carries a
/// deviator in proportion to its depth, as it carries pressure; extrapolated as a constant its shear would lack that of
/// half a support, and a layer of cohesionless soil would slide at 23 instead of 25 degrees. So it grows as the
/// pressure does, up to the yield stress at the wall particle, and with it what exceeds the yield stress in the soil,
/// which is viscous.
/// @param size    of the soil's deviator there, sqrt(t:t/2) [Pa]
/// @param p_wall  extrapolated pressure [Pa]
/// @param p_soil  the soil's, interpolated without its hydrostatic part [Pa]
/// @param yield_wall, yield_soil  yield stress at these pressures [Pa]
template <class Real>
HWY_INLINE Real deviator_growth(Real size, Real p_wall, Real p_soil, Real yield_wall, Real yield_soil) {
  const Real ratio = min(max(p_wall / p_soil, Real(0.0)), Real(max_stress_growth));
  const Real growth = select(p_soil > Real(0.0), ratio, Real(1.0));
  const Real viscous = max(size - yield_soil, Real(0.0)), plastic = size - viscous;
  const Real at_wall = fma(growth, viscous, min(growth * plastic, yield_wall));
  return select(size > Real(0.0), at_wall / size, Real(1.0));
}

/// A wall particle that sees less of the soil than this share of W(0) sees nothing: in single precision the inverse of
/// a kernel sum that is almost zero would be infinite.
inline constexpr double min_kernel_sum = 1e-24;

/// The soil's stress at a wall particle.
template <class Real>
struct WallStress {
  Symmetric<Real> s;   ///< [Pa]
  Real p;              ///< [Pa]
  Real density_ratio;  ///< rho/rho0 [-]; 0 where no soil is near
};

/// Shepard interpolation of the soil's stress to a wall particle, pressure with the hydrostatic term of Adami 2012:
/// p_w = sum_f (p_f + rho_f g.r_wf) W / sum_f W, at most max_stress_growth sum_f p_f W / sum_f W; the deviator as sum_f
/// t_f W / sum_f W, enlarged by deviator_growth; cohesion and friction as plain averages.
template <class Real>
struct WallStressSum {
  Real weight, p, p_soil, q, c, tan_phi;
  Deviator<Real> t;

  static HWY_INLINE WallStressSum zero() {
    const Real zero(0.0);
    return {zero, zero, zero, zero, zero, zero, {zero, zero, zero}};
  }

  /// What a soil particle gives.
  struct Source {
    Symmetric<Real> s;  ///< Cauchy stress [Pa]
    Real p, rho, q;     ///< pressure [Pa], density [kg/m3], rho/rho0 - 1 [-]
    Real c, tan_phi;    ///< cohesion [Pa], tangent of the friction angle [-]
  };

  /// @param W    kernel over its normalisation
  /// @param g_r  g.r_wf [m2/s2]; the hydrostatic part of q is linearised: rho/rho0 grows by g.r/c_s^2
  HWY_INLINE void add(Real W, const Source& f, Real g_r, Real per_c2) {
    weight = weight + W;
    p_soil = fma(W, f.p, p_soil);
    p = fma(W, fma(f.rho, g_r, f.p), p);
    q = fma(W, fma(g_r, per_c2, f.q), q);
    c = fma(W, f.c, c);
    tan_phi = fma(W, f.tan_phi, tan_phi);
    t = fma(W, Deviator<Real>{f.s.xx + f.p, f.s.yy + f.p, f.s.xy}, t);
  }

  /// @param of_wall  strength of the wall, infinite where it has none; a weaker one bounds the shear along the wall
  /// @param smooth   where the boundary has WallSlip::free_slip
  template <class Mask>
  HWY_INLINE WallStress<Real> value(const FlowConstants& k, Vector<Real> normal, MohrCoulomb<Real> of_wall,
                                    Mask smooth) const {
    const auto covered = weight > Real(min_kernel_sum);
    const Real inverse = select_or_zero(covered, Real(1.0) / weight);
    const Real p_mean = p_soil * inverse, factor(yield_factor(k.rheology.shear_rate));
    // The weight of soil that bears no pressure is not added: it would hold the soil up without friction, which is
    // that of the soil's own stress, and single particles would glide.
    Real p_wall = min(p * inverse, Real(max_stress_growth) * max(p_mean, Real(0.0)));
    if (k.numerics.tension_cutoff) p_wall = max(p_wall, Real(0.0));
    const MohrCoulomb<Real> soil{c * inverse, tan_phi * inverse};
    const auto yield = [&](MohrCoulomb<Real> of, Real at)
                           HWY_ATTR { return factor * yield_stress(of.c, of.tan_phi, at); };
    const Real size = magnitude(t) * inverse;
    const Real growth = deviator_growth(size, p_wall, p_mean, yield(soil, p_wall), yield(soil, p_mean));
    const Real share = inverse * select(smooth, Real(1.0), growth);
    Symmetric<Real> s{fms(t.xx, share, p_wall), fms(t.yy, share, p_wall), t.xy * share};
    if (any(smooth)) s = select(smooth, mirrored(s, normal), s);
    MohrCoulomb<Real> both{min(soil.c, of_wall.c), min(soil.tan_phi, of_wall.tan_phi)};
    if (has_turbulent_walls(k.boundaries)) both = weaker_strength(soil, of_wall, p_wall);
    const Real limit = yield(both, p_wall);
    const auto weaker = limit < yield(soil, p_wall);
    if (any(weaker)) s = select(weaker, with_bounded_shear(s, normal, limit), s);
    return {s, p_wall, select_or_zero(covered, fma(q, inverse, Real(1.0)))};
  }
};

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
