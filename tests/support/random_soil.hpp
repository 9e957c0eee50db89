#pragma once
// Random soil for tests: a jittered lattice with non-uniform masses, densities, velocities and strengths, so that a
// swapped index shows.

#include <cmath>
#include <cstdint>
#include <random>

#include "integrate/vectorised_flow.hpp"
#include "neighbours/cell_list.hpp"
#include "soil_arrays.hpp"
#include "sph/right_hand_side.hpp"

namespace talus::testing_support {

inline Soil random_soil(int nx, int ny, double dx, unsigned seed, int materials = 1) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  Soil s;
  const auto n = static_cast<std::size_t>(nx * ny);
  for_each_real(s, [&](const char*, auto& a) { a.assign(n, 0.0); });
  s.material.assign(n, 0);
  s.id.resize(n);
  s.n_active = n;
  s.x_sorted.assign(n, 0.0f);
  s.y_sorted.assign(n, 0.0f);
  for (std::size_t i = 0; i < n; ++i) {
    const auto col = static_cast<double>(i % static_cast<std::size_t>(nx)),
               row = static_cast<double>(i / static_cast<std::size_t>(nx));
    s.x[i] = (col + 0.25 * u(engine)) * dx;
    s.y[i] = (row + 0.25 * u(engine)) * dx;
    s.vx[i] = 2.0 * u(engine);
    s.vy[i] = 2.0 * u(engine);
    s.rho[i] = 2000 * (1 + 0.02 * u(engine));
    s.m[i] = 2000 * dx * dx * (1 + 0.3 * u(engine));
    s.tan_phi[i] = 0.5 + 0.2 * u(engine);
    s.c[i] = 700 + 300 * u(engine);
    s.txx[i] = 900 * u(engine);
    s.tyy[i] = 900 * u(engine);
    s.txy[i] = 900 * u(engine);
    s.material[i] = static_cast<std::int32_t>(i % static_cast<std::size_t>(materials));
    s.id[i] = static_cast<std::int32_t>(i);
  }
  return s;
}

/// Gives each particle a reference density and a viscosity of its own; rho/rho0 and m/rho0 stay.
inline void vary_properties(Soil& soil) {
  soil.rho0.resize(soil.size());
  soil.eta.resize(soil.size());
  for (std::size_t i = 0; i < soil.size(); ++i) {
    const double ratio = 1.0 + 0.3 * std::sin(1.7 * static_cast<double>(soil.id[i]));
    soil.rho0[i] = 2000 * ratio;
    soil.rho[i] *= ratio;
    soil.m[i] *= ratio;
    soil.eta[i] = 30 + 20 * std::cos(2.3 * static_cast<double>(soil.id[i]));
  }
}

/// Sorts the soil by cell and returns the cells.
inline CellList sorted(Soil& soil, double reach) {
  CellList cells;
  cells.build(soil.x, soil.y, reach);
  std::vector<double> scratch;
  for_each_real(soil, [&](const char*, auto& a) { permute(a, cells.order(), scratch); });
  permute(soil.material, cells.order(), scratch);
  permute(soil.id, cells.order(), scratch);
  return cells;
}

/// Evaluates once, by the loops that the constants ask for.
inline void evaluate(const FlowConstants& k, Soil& soil, WallParticles& walls, const CellList& soil_cells,
                     const CellList& wall_cells) {
  if (!VectorisedFlow::serves(k.numerics)) return evaluate_plain(k, soil, walls, {soil_cells, wall_cells});
  VectorisedFlow flow(k, soil);
  flow.rebuild_neighbour_lists(soil, walls, {soil_cells, wall_cells}, 0.0, 0.0);
  flow.evaluate(soil, walls, 0.0, true);
  flow.read_evaluation(soil, soil);
}

inline FlowConstants constants(double dx, Vec2 g = {0.0, -9.81},
                               std::vector<Material> materials = {{"a", 2000, 0.5, 700, 30}}) {
  FlowConstants k;
  k.h = 1.2 * dx;
  k.dx = dx;
  k.c_s = 50;
  k.g = g;
  k.numerics.precision =
      Precision::full;  // formulas are tested to the last digits; the vectorised loops have tests of their own
  k.soils = constitutive_parameters(materials, {}, k.c_s);
  k.boundaries.emplace_back();
  return k;
}

/// A flat bed of wall particles below y = -dx/2, three layers deep, from x = -5 dx to (nx + 4) dx.
inline WallParticles flat_walls(int nx, double dx) {
  WallParticles w;
  w.volume = dx * dx;
  for (int layer = 0; layer < 3; ++layer)
    for (int k = -5; k < nx + 5; ++k) {
      w.x.push_back(k * dx);
      w.y.push_back(-(layer + 1) * dx);
      w.nx.push_back(0);
      w.ny.push_back(1);
      w.depth.push_back((layer + 0.5) * dx);
    }
  w.boundary.assign(w.x.size(), 0);
  for_each_wall_real(w, [&](const char*, auto& a) { a.assign(w.x.size(), 0.0); });
  return w;
}

/// Sorts the walls by cell and returns the cells.
inline CellList sorted(WallParticles& w, double reach) {
  CellList cells;
  cells.build(w.x, w.y, reach);
  std::vector<double> scratch;
  for (auto* a : {&w.x, &w.y, &w.nx, &w.ny, &w.depth}) permute(*a, cells.order(), scratch);
  permute(w.boundary, cells.order(), scratch);
  return cells;
}

}  // namespace talus::testing_support
