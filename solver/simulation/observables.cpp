#include "simulation/observables.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "neighbours/cell_list.hpp"
#include "simulation/checks.hpp"
#include "simulation/thickness.hpp"
#include "support/digest.hpp"
#include "support/text.hpp"

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

/// The heaviest body whose particles are linked by gaps of at most `gap`: its particles in order of id.
std::vector<std::uint32_t> largest_body(const Soil& soil, double gap) {
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
  std::vector<double> mass(soil.size(), 0.0);
  std::vector<std::uint32_t> body = by_id(soil);
  for (const std::uint32_t i : body) mass[find_root(parent, i)] += soil.m[i];
  const auto root = static_cast<std::uint32_t>(std::ranges::max_element(mass) - mass.begin());
  std::erase_if(body, [&](std::uint32_t i) { return find_root(parent, i) != root; });
  return body;
}

/// Farthest run-out of some particles.
double farthest_of(std::span<const std::uint32_t> particles, const Soil& soil, const RunOutAxis& axis) {
  double most = axis.distance(soil.x[particles.front()]);
  for (const std::uint32_t i : particles) most = std::max(most, axis.distance(soil.x[i]));
  return most;
}

/// Of some particles, those that are still on the terrain, in order of run-out.
std::vector<SoilParcel> parcels_of(std::span<const std::uint32_t> particles, const Soil& soil, const RunOutAxis& axis,
                                   std::span<const Material> materials) {
  std::vector<SoilParcel> parcels;
  for (const std::uint32_t i : particles)
    if (i < soil.n_active)
      parcels.push_back({.run_out = axis.distance(soil.x[i]), .area = reference_area(soil, materials, i)});
  std::ranges::stable_sort(parcels, {}, &SoilParcel::run_out);
  return parcels;
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

Measures measure_fronts(const Soil& soil, const Terrain& terrain, double dx, std::span<const Material> materials) {
  const RunOutAxis& axis = terrain.run_out;
  const std::vector<std::uint32_t> body = largest_body(soil, 1.5 * dx);
  const std::vector<SoilParcel> deposit = parcels_of(body, soil, axis, materials);
  return {
      .influence_zone = farthest(soil, axis),
      .front_connected = farthest_of(body, soil, axis),
      .front_mass_99 = mass_front(soil, axis, 0.01),
      .front_mass_999 = mass_front(soil, axis, 0.001),
      .centre_of_mass_x = axis.distance(centre_of_mass(soil).x),
      .front_at_thickness =
          front_at_thickness(deposit, dx, terrain.front_thickness).value_or(std::numeric_limits<double>::quiet_NaN())};
}

std::vector<std::string> lower_bounds(const Soil& soil, const Terrain& terrain, const Measures& measures) {
  const RunOutAxis& axis = terrain.run_out;
  const double end = axis.distance((axis.to == SlidesTo::right ? terrain.bed.back() : terrain.bed.front()).x);
  bool left = false;
  for (std::size_t i = soil.n_active; i < soil.size(); ++i) left = left || axis.distance(soil.x[i]) >= end;
  std::vector<std::string> keys;
  for (const Measure& measure : measure_table) {
    const double value = measures.*measure.member;
    // Of a body that goes on beyond the end nobody knows where it is thick.
    const double reach = measure.member == &Measures::front_at_thickness ? measures.front_connected : value;
    if (left && !std::isnan(value) && (!measure.front || reach >= end)) keys.emplace_back(measure.key);
  }
  return keys;
}

std::vector<std::string> notes_on(const Measures& measures, double front_thickness, double dx) {
  std::vector<std::string> notes;
  if (std::isnan(measures.front_at_thickness))
    notes.push_back("the deposit is nowhere " + rounded(front_thickness) +
                    " m thick (terrain.front_thickness_m), so front_at_thickness_m has no value");
  const double ahead_of_body = measures.influence_zone - measures.front_connected;
  const double ahead_of_mass = measures.influence_zone - measures.front_mass_99;
  const double mass_ahead = measures.front_mass_99 - measures.front_connected;
  if (std::min(ahead_of_body, ahead_of_mass) > thrown_ahead * dx)
    notes.push_back("the farthest particle lies " + rounded(ahead_of_mass) +
                    " m ahead of the front of 99 % of the mass and " + rounded(ahead_of_body) +
                    " m ahead of the connected body: it was thrown ahead and is not the front of the deposit");
  if (mass_ahead > thrown_ahead * dx)
    notes.push_back("the front of 99 % of the mass lies " + rounded(mass_ahead) +
                    " m ahead of the connected body: more than 1 % of the soil is separate from it");
  return notes;
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
