// Writes DIR/snapshots.vtkhdf (known_frame, interrupted and resumed half way) and DIR/points.vtkhdf for
// test_vtkhdf_vtk.py.

#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "io/vtkhdf.hpp"
#include "known_frame.hpp"

int main(int argc, char** argv) try {
  if (argc != 5) {
    std::cerr << "usage: write_known_snapshots DIR PARTICLES SOIL STEPS\n";
    return 2;
  }
  const std::filesystem::path directory = argv[1];
  const auto n = static_cast<std::size_t>(std::atol(argv[2]));
  const auto n_soil = static_cast<std::size_t>(std::atol(argv[3]));
  const auto steps = static_cast<std::size_t>(std::atol(argv[4]));
  const auto frame = [&](std::size_t k) { return talus::test::known_frame(n, n_soil, k); };

  const auto file = directory / "snapshots.vtkhdf";
  const std::size_t interrupted = steps / 2;
  const std::size_t checkpoint = steps / 3;
  {
    talus::SnapshotWriter writer(file, frame(0));
    for (std::size_t k = 1; k < interrupted; ++k) writer.append(frame(k));
  }
  auto writer = talus::SnapshotWriter::resume(file, frame(checkpoint).time);
  for (std::size_t k = checkpoint + 1; k < steps; ++k) writer.append(frame(k));
  writer.close();

  const talus::Frame f = frame(1);
  const std::vector<talus::NamedArray> arrays = {{"friction_angle_deg", f.shear_rate}, {"tan_phi", f.density}};
  talus::write_points(directory / "points.vtkhdf", f.position, arrays);
  return 0;
} catch (const std::exception& e) {
  std::cerr << e.what() << "\n";
  return 1;
}
