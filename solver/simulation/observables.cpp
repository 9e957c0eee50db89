#include "simulation/observables.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <numeric>

#include "neighbours/cell_list.hpp"
#include "support/digest.hpp"

namespace talus {
namespace {

/// Indices of the soil in order of id, so that sums and digests do not depend on how the particles are stored.
std::vector<std::uint32_t> by_id(const Soil& soil) {
  std::vector<std::uint32_t> place(soil.size());
  for (std::size_t i = 0; i < soil.size(); ++i)
    place[static_cast<std::size_t>(soil.id[i])] = static_cast<std::uint32_t>(i);
  return place;
}

/// Largest run-out beyond which at most `share` of the mass lies.
double mass_front(const Soil& soil, const RunOutAxis& axis, double share) {
  std::vector<double> x;
  for (std::size_t i = 0; i < soil.size(); ++i) x.push_back(axis.distance(soil.x[i]));
  std::vector<std::uint32_t> order(soil.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](auto a, auto b) { return x[a] != x[b] ? x[a] > x[b] : soil.id[a] < soil.id[b]; });
  const double total =
      std::accumulate(order.begin(), order.end(), 0.0, [&](double s, auto i) { return s + soil.m[i]; });
  double beyond = 0.0;
  for (const auto i : order) {
    beyond += soil.m[i];
    if (beyond > share * total) return x[i];
  }
  return x[order.back()];
}

/// Root of i in a union-find forest, halving the path on the way.
std::uint32_t find_root(std::vector<std::uint32_t>& parent, std::uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

/// Farthest run-out of the heaviest body whose particles are linked by gaps of at most `gap`.
double connected_front(const Soil& soil, const RunOutAxis& axis, double gap) {
  CellList cells;
  cells.build(soil.x, soil.y, gap);
  const auto order = cells.order();
  std::vector<std::uint32_t> parent(soil.size());
  std::iota(parent.begin(), parent.end(), 0u);
  for (std::uint32_t i = 0; i < soil.size(); ++i)
    cells.for_ranges(soil.position(i), [&](std::uint32_t begin, std::uint32_t end) {
      for (std::uint32_t k = begin; k < end; ++k) {
        const std::uint32_t j = order[k];
        if (j >= i || norm2(soil.position(i) - soil.position(j)) > gap * gap) continue;
        const std::uint32_t a = find_root(parent, i), b = find_root(parent, j);
        parent[std::max(a, b)] = std::min(a, b);
      }
    });
  std::vector<double> mass(soil.size(), 0.0), front(soil.size(), -1e300);
  for (const std::uint32_t i : by_id(soil)) {
    const std::uint32_t root = find_root(parent, i);
    mass[root] += soil.m[i];
    front[root] = std::max(front[root], axis.distance(soil.x[i]));
  }
  return front[static_cast<std::size_t>(std::max_element(mass.begin(), mass.end()) - mass.begin())];
}

}  // namespace

double farthest(const Soil& soil, const RunOutAxis& axis) {
  double most = axis.distance(soil.x.front());
  for (const double x : soil.x) most = std::max(most, axis.distance(x));
  return most;
}

double total_mass(const Soil& soil) {
  double mass = 0.0;
  for (const auto i : by_id(soil)) mass += soil.m[i];
  return mass;
}

Vec2 centre_of_mass(const Soil& soil) {
  Vec2 sum;
  double mass = 0.0;
  for (const auto i : by_id(soil)) {
    sum += soil.m[i] * soil.position(i);
    mass += soil.m[i];
  }
  return (1.0 / mass) * sum;
}

double kinetic_energy(const Soil& soil) {
  double energy = 0.0;
  for (const auto i : by_id(soil)) energy += 0.5 * soil.m[i] * norm2(soil.velocity(i));
  return energy;
}

double rms_speed(const Soil& soil) {
  double energy = 0.0, mass = 0.0;
  for (const auto i : by_id(soil)) {
    if (i >= soil.n_active) continue;
    energy += 0.5 * soil.m[i] * norm2(soil.velocity(i));
    mass += soil.m[i];
  }
  return mass > 0.0 ? std::sqrt(2.0 * energy / mass) : 0.0;
}

double max_speed(const Soil& soil) {
  double v2 = 0.0;
  for (std::size_t i = 0; i < soil.n_active; ++i) v2 = std::max(v2, norm2(soil.velocity(i)));
  return std::sqrt(v2);
}

Measures measure_fronts(const Soil& soil, const RunOutAxis& axis, double dx) {
  return {farthest(soil, axis), connected_front(soil, axis, 1.5 * dx), mass_front(soil, axis, 0.01),
          mass_front(soil, axis, 0.001), axis.distance(centre_of_mass(soil).x)};
}

std::vector<std::string> lower_bounds(const Soil& soil, const Terrain& terrain, const Measures& measures) {
  const RunOutAxis& axis = terrain.run_out;
  const double end = axis.distance((axis.to == SlidesTo::right ? terrain.bed.back() : terrain.bed.front()).x);
  bool left = false;
  for (std::size_t i = soil.n_active; i < soil.size(); ++i) left = left || axis.distance(soil.x[i]) >= end;
  std::vector<std::string> keys;
  for (const Measure& measure : measure_table)
    if (left && (!measure.front || measures.*measure.member >= end)) keys.emplace_back(measure.key);
  return keys;
}

std::string digest(const Soil& soil) {
  std::uint64_t hash = fnv1a64_start;
  for (const auto i : by_id(soil))
    for (const double value :
         {soil.x[i], soil.y[i], soil.vx[i], soil.vy[i], soil.rho[i], soil.txx[i], soil.tyy[i], soil.txy[i]})
      // Little-endian bytes, which is the order in memory of every machine that Talus runs on.
      hash = fnv1a64({reinterpret_cast<const char*>(&value), sizeof value}, hash);
  return hex_digits(hash);
}

}  // namespace talus
