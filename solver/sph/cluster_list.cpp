#include "sph/cluster_list.hpp"

#include <cstdint>

namespace talus {

std::vector<std::uint32_t> clusters(const CellList& cells, std::size_t lanes) {
  std::vector<std::uint32_t> first;
  for (std::size_t r = 0; r < cells.rows(); ++r)
    for (std::size_t i = cells.row_begin(r); i < cells.row_begin(r + 1); i += lanes)
      first.push_back(static_cast<std::uint32_t>(i));
  first.push_back(cells.row_begin(cells.rows()));
  return first;
}

}  // namespace talus
