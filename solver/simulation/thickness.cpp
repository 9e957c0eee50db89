#include "simulation/thickness.hpp"

#include <algorithm>

namespace talus {
namespace {

constexpr double spread_in_spacings = 3.0;   ///< R: the reach of the default kernel [-]
constexpr double search_in_spacings = 0.25;  ///< steps of the search for the crossing, far below R [-]
constexpr int bisections = 40;               ///< of such a step: to 1e-12 of it

}  // namespace

double thickness(std::span<const SoilParcel> parcels, double spacing, double s) {
  const double spread = spread_in_spacings * spacing;
  const auto first = std::ranges::upper_bound(parcels, s - spread, {}, &SoilParcel::run_out);
  double sum = 0.0;
  for (auto parcel = first; parcel != parcels.end() && parcel->run_out < s + spread; ++parcel) {
    const double q = (s - parcel->run_out) / spread;
    sum += parcel->area * (1.0 - q * q) * (1.0 - q * q);
  }
  return 15.0 / (16.0 * spread) * sum;
}

std::optional<double> front_at_thickness(std::span<const SoilParcel> parcels, double spacing, double least) {
  if (parcels.empty()) return std::nullopt;
  const double step = search_in_spacings * spacing, spread = spread_in_spacings * spacing;
  const double nearest = parcels.front().run_out - spread;
  double thin = parcels.back().run_out + spread;
  double thick = thin - step;
  while (thickness(parcels, spacing, thick) < least) {
    if (thick < nearest) return std::nullopt;
    thin = thick;
    thick -= step;
  }
  for (int k = 0; k < bisections; ++k) {
    const double middle = 0.5 * (thin + thick);
    (thickness(parcels, spacing, middle) < least ? thin : thick) = middle;
  }
  return thick;
}

}  // namespace talus
