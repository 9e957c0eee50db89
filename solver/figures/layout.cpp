#include "figures/layout.hpp"

#include <algorithm>
#include <cmath>

namespace talus::figures {
namespace {

constexpr double header = 68;        // px: title and subtitle
constexpr double footer = 34;        // px: source line
constexpr double left = 62;          // px: y tics and label of each panel
constexpr double right = 24;         // px
constexpr double beneath = 46;       // px: x tics and label of each panel
constexpr double tallest = 440;      // px, of one panel
constexpr double narrowest = 760;    // px, so that title and colour bar find room
constexpr double tall_sheet = 1250;  // px: more columns rather than a taller sheet

}  // namespace

Layout profile_layout(std::size_t n, const Box& view, double caption) {
  Layout layout;
  for (std::size_t columns = 1; columns <= 4; ++columns) {
    layout.canvas.width = columns == 1 ? 1040 : 1320;
    const double widest = layout.canvas.width / static_cast<double>(columns) - left - right;
    layout.metre = std::min(widest / view.width(), tallest / view.height());
    const double width = layout.metre * view.width();
    const double height = layout.metre * view.height();
    const std::size_t rows = (n + columns - 1) / columns;
    const double pitch = caption + height + beneath;
    layout.canvas.height = std::round(header + static_cast<double>(rows) * pitch + footer);
    layout.panels.clear();
    for (std::size_t k = 0; k < n; ++k) {
      const double x = static_cast<double>(k % columns) * (left + width + right) + left;
      const double y = header + static_cast<double>(k / columns) * pitch + caption;
      layout.panels.push_back({x, x + width, y, y + height});
    }
    layout.canvas.width = std::max(narrowest, std::round(layout.panels[std::min(n, columns) - 1].right + right));
    if (layout.canvas.height <= tall_sheet) break;
  }
  return layout;
}

}  // namespace talus::figures
