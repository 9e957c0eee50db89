#pragma once
// Where the panels of a sequence of profiles go: equal aspect, as large as fits.

#include <vector>

#include "figures/canvas.hpp"

namespace talus::figures {

/// Panels of equal size, row by row, on a canvas made for them.
struct Layout {
  Canvas canvas;
  std::vector<Panel> panels;
  double metre;  ///< px per metre, the same in x and y
};

/// @param n        panels, >= 1
/// @param view     what each shows [m]
/// @param caption  height of the caption row above each [px]
Layout profile_layout(std::size_t n, const Box& view, double caption);

}  // namespace talus::figures
