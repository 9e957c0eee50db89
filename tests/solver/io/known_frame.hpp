#pragma once
// A frame whose numbers follow from a particle's number and the step: test_vtkhdf_vtk.py knows the same formulas.

#include <cmath>
#include <cstdint>

#include "math/angle.hpp"
#include "simulation/frame.hpp"

namespace talus::test {

/// An exact float32 for channel < 16, i < 4096, k < 64 * 64: another one for each of them, and of either sign.
inline double known_value(int channel, std::size_t i, std::size_t k) {
  return (channel % 2 == 0 ? 1.0 : -1.0) * (4096.0 * channel + static_cast<double>(i) + static_cast<double>(k) / 64.0);
}

/// Step k of n particles of which n_soil are soil; its time is k / 10.
inline Frame known_frame(std::size_t n, std::size_t n_soil, std::size_t k) {
  Frame f;
  f.time = static_cast<double>(k) / 10.0;
  f.step = static_cast<std::int64_t>(100 * k);
  f.n_soil = n_soil;
  for (std::size_t i = 0; i < n; ++i) {
    const auto value = [i, k](int channel) { return known_value(channel, i, k); };
    f.position.push_back({value(0), value(1)});
    f.displacement.push_back({value(2), value(3)});
    f.velocity.push_back({value(4), value(5)});
    f.density.push_back(value(6));
    f.pressure.push_back(value(7));
    f.tan_phi.push_back(std::tan(radians(static_cast<double>(i % 128) / 4.0 + static_cast<double>(k) / 64.0)));
    f.shear_rate.push_back(value(8));
    f.stress.push_back({value(9), value(10), value(11), value(12)});
  }
  return f;
}

}  // namespace talus::test
