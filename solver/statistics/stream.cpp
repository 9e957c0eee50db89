#include "statistics/stream.hpp"

#include <Random123/philox.h>

#include <cmath>
#include <numbers>

namespace talus {
namespace {

std::uint32_t low(std::uint64_t word) { return static_cast<std::uint32_t>(word); }
std::uint32_t high(std::uint64_t word) { return static_cast<std::uint32_t>(word >> 32); }

/// The middle of one of 2^52 equal intervals of (0, 1): neither 0 nor 1 can come out.
double unit(std::uint32_t lo, std::uint32_t hi) {
  const std::uint64_t word = (static_cast<std::uint64_t>(hi) << 32) | lo;
  return (static_cast<double>(word >> 12) + 0.5) * 0x1p-52;
}

}  // namespace

double normal_of(std::span<const double, 2> uniform) {
  return std::sqrt(-2 * std::log(uniform[0])) * std::cos(2 * std::numbers::pi * uniform[1]);
}

std::array<double, 2> uniforms(std::uint64_t seed, std::uint64_t index, std::uint32_t mode, Stream stream) {
  const r123::Philox4x32::key_type key = {{low(seed), high(seed)}};
  const r123::Philox4x32::ctr_type counter = {{mode, static_cast<std::uint32_t>(stream), low(index), high(index)}};
  const r123::Philox4x32::ctr_type words = r123::Philox4x32()(counter, key);
  return {unit(words[0], words[1]), unit(words[2], words[3])};
}

double standard_normal(std::uint64_t seed, std::uint64_t realization, std::uint32_t mode, std::uint32_t field) {
  return normal_of(uniforms(seed, realization, mode, stream_of(Stream::field, field)));
}

}  // namespace talus
