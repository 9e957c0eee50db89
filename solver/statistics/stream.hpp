#pragma once
// Counter-based random numbers: a draw is a pure function of what it is for, so it never depends on how many others
// were taken, on threads or on order. Philox4x32-10 (Salmon, Moraes, Dror & Shaw 2011) from Random123.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

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

/// A standard normal number from two uniform ones (Box & Muller 1958).
double normal_of(std::span<const double, 2> uniform);

}  // namespace talus
