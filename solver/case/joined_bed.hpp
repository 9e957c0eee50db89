#pragma once
// The bed under a slide that is given by surfaces: what stays in place of the ground.

#include <span>
#include <vector>

#include "math/vec2.hpp"

namespace talus {

/// The lower of ground and slip surface where the slip surface has an extent, the ground elsewhere. [m]
/// Where two surfaces meet with a gap of more than 0.1 % of the slip surface's extent a vertical face stands between
/// them; a smaller gap is closed: surveys and stability analyses round their coordinates.
/// @param ground  before the slide, from left to right
/// @param slip    from left to right; counts within the ground's extent, where there must be some of it
/// @param beyond  replaces the ground outside the slide, as far as it goes; may be empty
/// @param slide   box around the soil between ground and slip surface
std::vector<Vec2> joined_bed(std::span<const Vec2> ground, std::span<const Vec2> slip, std::span<const Vec2> beyond,
                             const Box& slide);

}  // namespace talus
