#pragma once
// Counter-based random numbers: a draw is a pure function of what it is for, so it never depends on how many others
// were taken, on threads or on order. Philox4x32-10 (Salmon, Moraes, Dror & Shaw 2011) from Random123.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "math/vec2.hpp"

namespace talus {

/// What a draw is for; draws of different streams are independent.
enum class Stream : std::uint32_t { field = 0, strata = 1, jitter = 2, nugget = 3, subspace = 4 };
inline constexpr std::uint32_t stream_kinds = 5;

/// The stream of this kind that belongs to a field: its number times stream_kinds further on.
constexpr Stream stream_of(Stream kind, std::uint32_t field) {
  return static_cast<Stream>(static_cast<std::uint32_t>(kind) + stream_kinds * field);
}

/// Two independent uniform numbers in the open interval (0, 1), of 52 bits each.
/// @param index  realization, or place in a permutation
/// @param mode   number of the coefficient
std::array<double, 2> uniforms(std::uint64_t seed, std::uint64_t index, std::uint32_t mode, Stream stream);

/// The standard normal coefficient of a mode of a realization (Box & Muller 1958).
/// @param field  number of the field, where a realization has several
double standard_normal(std::uint64_t seed, std::uint64_t realization, std::uint32_t mode, std::uint32_t field = 0);

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
