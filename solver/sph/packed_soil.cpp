#include "sph/packed_soil.hpp"

#include <algorithm>

namespace talus {

void PackedSoil::resize(std::size_t n, Box box) {
  const std::size_t room = n + padding;
  if (x.size() != room) {
    for (auto* array : {&x, &y, &material}) array->assign(room, 0);
    for (auto* array : {&vx, &vy, &V, &q, &rho, &sxx, &syy, &sxy}) array->assign(room, 0.0f);
  }
  // 2^29 units over the box leave room for positions outside it and for differences of any two.
  lo_ = box.lo;
  quantum = std::max({box.width(), box.height(), 1e-300}) / static_cast<double>(1 << 29);
}

void PackedSoil::pack_state(const Soil& soil, Chunk chunk, std::span<const double> rho0) {
  const double per_quantum = 1.0 / quantum;
  for (std::size_t i = chunk.begin; i < chunk.end; ++i) {
    x[i] = static_cast<std::int32_t>((soil.x[i] - lo_.x) * per_quantum);
    y[i] = static_cast<std::int32_t>((soil.y[i] - lo_.y) * per_quantum);
    vx[i] = static_cast<float>(soil.vx[i]);
    vy[i] = static_cast<float>(soil.vy[i]);
    V[i] = static_cast<float>(soil.m[i] / soil.rho[i]);
    q[i] = static_cast<float>(soil.rho[i] / rho0[static_cast<std::size_t>(soil.material[i])] - 1.0);
    rho[i] = static_cast<float>(soil.rho[i]);
    material[i] = soil.material[i];
  }
}

void PackedSoil::pack_stress(const Soil& soil, Chunk chunk) {
  for (std::size_t i = chunk.begin; i < chunk.end; ++i) {
    sxx[i] = static_cast<float>(soil.sxx[i]);
    syy[i] = static_cast<float>(soil.syy[i]);
    sxy[i] = static_cast<float>(soil.sxy[i]);
  }
}

}  // namespace talus
