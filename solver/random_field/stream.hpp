#pragma once
// Draws of the fields: white noise of the plane and Latin hypercubes, from the counter-based numbers of
// statistics/stream.hpp.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "math/vec2.hpp"
#include "statistics/stream.hpp"

namespace talus {

/// White noise of the plane: an independent standard normal value at each point, to the micrometre, and all 0 for the
/// key 0.
/// @param key  a number that selects the noise, such as a standard normal coefficient
/// @param x    a point [m]
double white_noise(double key, Vec2 x);

/// Latin hypercube sample of the `modes` leading coefficients (McKay, Beckman & Conover 1979): over the realizations
/// 0 .. realizations-1, each coefficient falls once in each of as many intervals of equal probability. Modes are paired
/// at random. Depends on the number of realizations by nature. Takes O(realizations) time a mode.
/// @throws std::invalid_argument unless realization < realizations
std::vector<double> stratified_normals(std::uint64_t seed, std::uint64_t realizations, std::uint64_t realization,
                                       std::size_t modes, std::uint32_t field = 0);

}  // namespace talus
