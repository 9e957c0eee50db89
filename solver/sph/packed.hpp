#pragma once
// Particles as the vectorised pair loops read them: single precision, four values a group so that a neighbour is one or
// two cache lines, positions as fixed point so that differences of neighbours are exact however large the terrain.

#include <cstdint>
#include <vector>

#include "math/vec2.hpp"
#include "particles/geometry_input.hpp"

namespace talus {

/// Consecutive particles or clusters, [begin, end).
struct Range {
  std::size_t begin, end;
};

/// Positions in whole units of `quantum` from `lo`.
struct FixedPoint {
  Vec2 lo;               ///< [m]
  double quantum = 1.0;  ///< metres per unit

  /// For points of `box` and up to 4 h around it, in [0, 2^30]: room for differences of any two in 32 bits.
  static FixedPoint covering(Box box, double h);
};

/// Place n, one behind the last of n particles, is far from everything and has no volume; so are some more, so that
/// whole vectors can be loaded from anywhere. Integers are kept as bit patterns of floats.
struct PackedSoil {
  std::vector<float> motion;   ///< x, y [quantum, as integers], vx, vy [m/s]
  std::vector<float> density;  ///< m/rho [m2], rho/rho0 - 1 less its hydrostatic part [-], rho [kg/m3], material
  std::vector<float> stress;   ///< sxx, syy, sxy, p [Pa]
  std::vector<float> q;        ///< rho/rho0 - 1 [-], not grouped
  std::vector<float> ax, ay, drho, dtxx, dtyy, dtxy, gamma_dot;  ///< of the last evaluation, as in Soil

  void resize(std::size_t n);
  std::size_t size() const { return n_; }

 private:
  std::size_t n_ = 0;
};

/// The rates that a state can be moved on with; calls f(name, array).
template <class P, class F>
void for_each_packed_rate(P& s, F&& f) {
  f("ax", s.ax);
  f("ay", s.ay);
  f("drho", s.drho);
  f("dtxx", s.dtxx);
  f("dtyy", s.dtyy);
  f("dtxy", s.dtxy);
}

/// WallSlip as PackedWalls keeps it.
constexpr float slip_code(WallSlip slip) { return static_cast<float>(slip); }

struct PackedWalls {
  std::vector<float> place;    ///< x, y [quantum, as integers], nx, ny [-]
  std::vector<float> stress;   ///< sxx, syy, sxy [Pa], depth [m]
  std::vector<float> slip;     ///< WallSlip as a number, not grouped
  std::vector<float> tan_phi;  ///< of the wall's friction angle, infinite where it has none [-], not grouped
  void resize(std::size_t n);
};

}  // namespace talus
