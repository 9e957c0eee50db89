#include "simulation/flow_thickness.hpp"

#include <cmath>
#include <cstdint>
#include <map>

#include "simulation/observables.hpp"

namespace talus {
namespace {

constexpr double column_width = 4.0;  ///< [dx]

struct Column {
  double area = 0.0;      ///< of the soil at its reference density [m2]
  double momentum = 0.0;  ///< sum of m |v| [kg/s]
};

}  // namespace

void FlowThickness::observe(const Soil& soil, std::span<const Material> materials, double dx, double time) {
  const double width = column_width * dx;
  std::map<std::int64_t, Column> columns;
  for (std::size_t i = 0; i < soil.n_active; ++i) {
    Column& column = columns[static_cast<std::int64_t>(std::floor(soil.x[i] / width))];
    column.area += reference_area(soil, materials, i);
    column.momentum += soil.m[i] * norm(soil.velocity(i));
  }
  for (const auto& [place, column] : columns) {
    sums_[0] += (time - time_) * column.momentum;
    sums_[1] += (time - time_) * column.momentum * column.area / (width * dx);
  }
  time_ = time;
}

}  // namespace talus
