#pragma once
// Soil particles that got behind a wall, which must not happen: a run in which any did is not to be trusted.

#include <cstdint>
#include <vector>

#include "particles/geometry.hpp"
#include "particles/particles.hpp"

namespace talus {

/// Remembers, by id, which particles have ever been seen behind a wall.
class WallCrossings {
 public:
  WallCrossings(std::vector<Polyline> walls, std::size_t particles) : walls_(std::move(walls)), seen_(particles, 0) {}

  /// Looks at the active soil, in parallel.
  void observe(const Soil& soil);
  /// Particles seen so far.
  std::int64_t count() const;

  /// By id: 1 for those seen; for checkpoints.
  const std::vector<std::uint8_t>& seen() const { return seen_; }
  void restore(std::vector<std::uint8_t> seen) { seen_ = std::move(seen); }

 private:
  std::vector<Polyline> walls_;
  std::vector<std::uint8_t> seen_;
};

}  // namespace talus
