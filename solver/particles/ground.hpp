#pragma once
// The nearest point of the ground.

#include <cstdint>
#include <memory>
#include <vector>

#include "math/vec2.hpp"
#include "particles/geometry_input.hpp"

namespace talus {

/// Nearest point of several lines, in logarithmic time. Thread-safe once built.
class Ground {
 public:
  /// Where a point stands.
  struct Nearest {
    Vec2 point;              ///< on a line [m]
    double distance = 0.0;   ///< [m], positive on the soil's side
    Vec2 normal;             ///< unit normal there, towards the soil; at a vertex towards the point
    std::uint32_t line = 0;  ///< index of the line
    bool past_end = false;   ///< the nearest point is the end of an open line, and `point` lies beyond it
  };

  /// @param lines  at least one
  explicit Ground(std::vector<Polyline> lines);
  ~Ground();
  Nearest nearest(Vec2 point) const;

 private:
  struct Segments;
  std::unique_ptr<const Segments> segments_;
};

}  // namespace talus
