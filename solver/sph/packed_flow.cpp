#include "sph/packed_flow.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace talus {

FixedPoint FixedPoint::covering(Box box, double h) {
  return {{box.lo.x - 4.0 * h, box.lo.y - 4.0 * h},
          (std::max(box.width(), box.height()) + 8.0 * h) / static_cast<double>(1 << 30)};
}

namespace {

constexpr std::size_t padding = 16;  ///< particles behind the last

/// Groups of four, first two values far away behind place n.
void resize_places(std::vector<float>& groups, std::size_t n) {
  const float far = std::bit_cast<float>(std::int32_t{3 << 29});
  groups.assign(4 * (n + padding), 0.0f);
  for (std::size_t i = 4 * n; i < groups.size(); i += 4) groups[i] = groups[i + 1] = far;
}

}  // namespace

void PackedSoil::resize(std::size_t n) {
  n_ = n;
  resize_places(motion, n);
  for (auto* group : {&density, &stress, &strain}) group->assign(4 * (n + padding), 0.0f);
  for (auto* array : {&q, &c, &tan_phi, &ax, &ay, &drho, &dtxx, &dtyy, &dtxy, &gamma_dot})
    array->assign(n + padding, 0.0f);
}

void PackedWalls::resize(std::size_t n) {
  if (place.size() == 4 * (n + padding)) return;
  resize_places(place, n);
  stress.assign(4 * (n + padding), 1.0f);  // a depth, that one can divide by
  slip.assign(n + padding, 0.0f);
  tan_phi.assign(n + padding, 0.0f);
  c.assign(n + padding, 0.0f);
  slot.assign(n + padding, -1);
}

std::vector<std::uint32_t> clusters(const CellList& cells, std::size_t lanes) {
  std::vector<std::uint32_t> first;
  for (std::size_t r = 0; r < cells.rows(); ++r)
    for (std::size_t i = cells.row_begin(r); i < cells.row_begin(r + 1); i += lanes)
      first.push_back(static_cast<std::uint32_t>(i));
  first.push_back(cells.row_begin(cells.rows()));
  return first;
}

}  // namespace talus
