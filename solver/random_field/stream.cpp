#include "random_field/stream.hpp"

#include <algorithm>
#include <bit>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace talus {
namespace {

std::uint32_t low(std::uint64_t word) { return static_cast<std::uint32_t>(word); }

/// A coordinate in whole micrometres.
std::uint64_t micrometres(double x) { return static_cast<std::uint64_t>(std::llround(x * 1e6)); }

/// Place of `realization` in a random permutation of 0 .. realizations-1 (Fisher & Yates), one permutation per mode.
std::uint64_t stratum(std::uint64_t seed, std::uint64_t realizations, std::uint64_t realization, std::uint32_t mode,
                      std::uint32_t field) {
  std::vector<std::uint64_t> strata(realizations);
  std::iota(strata.begin(), strata.end(), std::uint64_t{0});
  for (std::uint64_t n = realizations - 1; n > 0; --n) {
    const double u = uniforms(seed, n, mode, stream_of(Stream::strata, field))[0];
    std::swap(strata[n], strata[static_cast<std::uint64_t>(u * static_cast<double>(n + 1))]);
  }
  return strata[realization];
}

}  // namespace

double white_noise(double key, Vec2 x) {
  if (key == 0) return 0;
  return normal_of(
      uniforms(std::bit_cast<std::uint64_t>(key), micrometres(x.x), low(micrometres(x.y)), Stream::nugget));
}

std::vector<double> stratified_normals(std::uint64_t seed, std::uint64_t realizations, std::uint64_t realization,
                                       std::size_t modes, std::uint32_t field) {
  if (realization >= realizations) throw std::invalid_argument("stratified_normals: no such realization");
  const boost::math::normal_distribution<double> normal;
  std::vector<double> xi(modes);
  for (std::size_t k = 0; k < modes; ++k) {
    const auto mode = static_cast<std::uint32_t>(k);
    const double place = static_cast<double>(stratum(seed, realizations, realization, mode, field));
    const double jitter = uniforms(seed, realization, mode, stream_of(Stream::jitter, field))[0];
    const double p = (place + jitter) / static_cast<double>(realizations);
    xi[k] = quantile(normal, std::min(p, std::nextafter(1.0, 0.0)));
  }
  return xi;
}

}  // namespace talus
