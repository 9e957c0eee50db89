// Writes DIR/snapshots.vtkhdf (known_frame, interrupted and resumed half way), DIR/far.vtkhdf (the same of a case on a
// national grid) and DIR/points.vtkhdf for test_vtkhdf_vtk.py.

#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "io/vtkhdf.hpp"
#include "known_frame.hpp"

namespace {

using talus::Frame;

/// Writes steps 0 .. steps-1, interrupted half way and resumed from step steps/3.
template <class FrameOf>
void write_interrupted(const std::filesystem::path& file, std::size_t steps, const FrameOf& frame) {
  const std::size_t interrupted = steps / 2;
  const std::size_t checkpoint = steps / 3;
  {
    talus::SnapshotWriter writer(file, frame(0));
    for (std::size_t k = 1; k < interrupted; ++k) writer.append(frame(k));
  }
  auto writer = talus::SnapshotWriter::resume(file, frame(checkpoint).time);
  for (std::size_t k = checkpoint + 1; k < steps; ++k) writer.append(frame(k));
  writer.close();
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 5) {
    std::cerr << "usage: write_known_snapshots DIR PARTICLES SOIL STEPS\n";
    return 2;
  }
  const std::filesystem::path directory = argv[1];
  const auto n = static_cast<std::size_t>(std::atol(argv[2]));
  const auto n_soil = static_cast<std::size_t>(std::atol(argv[3]));
  const auto steps = static_cast<std::size_t>(std::atol(argv[4]));
  const auto frame = [&](std::size_t k) {
    Frame f = talus::test::known_frame(n, n_soil, k);
    for (std::size_t i = 0; i < n; ++i) f.cohesion.push_back(talus::test::known_value(13, i, k));
    return f;
  };

  write_interrupted(directory / "snapshots.vtkhdf", steps, frame);
  write_interrupted(directory / "far.vtkhdf", 4, [&](std::size_t k) {
    Frame far = frame(k);
    far.origin = {2'683'000.0, 1'247'000.0};
    for (talus::Vec2& x : far.position) x += {1e-6, 1e-6};
    return far;
  });

  const Frame f = frame(1);
  const std::vector<talus::NamedArray> arrays = {{"friction_angle_deg", f.shear_rate}, {"tan_phi", f.density}};
  talus::write_points(directory / "points.vtkhdf", f.position, arrays);
  return 0;
} catch (const std::exception& e) {
  std::cerr << e.what() << "\n";
  return 1;
}
