#include <algorithm>
#include <cstdint>

#include "io/vtkhdf.hpp"
#include "io/vtkhdf_layout.hpp"
#include "support/error.hpp"

namespace talus {
namespace {

namespace fs = std::filesystem;

hdf5::Id open_snapshots(const fs::path& path) {
  hdf5::Id file = hdf5::open_file(path, hdf5::Access::read);
  if (!hdf5::has(file, "VTKHDF") || !hdf5::has(file, vtkhdf::own_group))
    throw IoError(path.string() + " is not a file of snapshots of Talus");
  return file;
}

std::vector<double> times_of(const hdf5::Id& file) {
  const hdf5::Id steps = hdf5::open_group(file, "VTKHDF/Steps");
  const auto count = hdf5::read_attribute<std::int64_t>(steps, "NSteps");
  return hdf5::read_rows<double>(steps, "Values", 0, static_cast<std::size_t>(std::max<std::int64_t>(count, 0)));
}

void read_field(hid_t group, const vtkhdf::Field& field, std::size_t first, Frame& frame) {
  const std::size_t n = frame.position.size();
  const auto components = static_cast<std::size_t>(field.components);
  const std::vector<float> values = hdf5::read_rows<float>(group, field.name, first, n);
  if (values.size() != n * components)
    throw IoError(std::string("the snapshots' array ") + field.name + " has another shape than expected");
  for (std::size_t i = 0; i < n; ++i) field.set(frame, i, &values[i * components]);
}

void resize(Frame& f, std::size_t n) {
  f.position.resize(n);
  f.displacement.resize(n);
  f.velocity.resize(n);
  f.density.resize(n);
  f.pressure.resize(n);
  f.tan_phi.resize(n);
  f.shear_rate.resize(n);
  f.stress.resize(n);
}

}  // namespace

std::vector<double> snapshot_times(const fs::path& path) { return times_of(open_snapshots(path)); }

Frame read_frame(const fs::path& path, std::size_t index) {
  const hdf5::Id file = open_snapshots(path);
  const std::vector<double> times = times_of(file);
  if (index >= times.size())
    throw IoError(path.string() + " has " + std::to_string(times.size()) + " steps; there is no step " +
                  std::to_string(index));
  const hdf5::Id grid = hdf5::open_group(file, "VTKHDF");
  const hdf5::Id data = hdf5::open_group(grid, "PointData");
  const auto walls = hdf5::read_array<std::int32_t>(data, vtkhdf::is_wall);
  const std::size_t n = walls.size();

  Frame frame;
  frame.time = times[index];
  frame.step = hdf5::read_rows<std::int64_t>(hdf5::open_group(file, vtkhdf::own_group), "step", index, 1)[0];
  frame.n_soil = static_cast<std::size_t>(std::count(walls.begin(), walls.end(), 0));
  resize(frame, n);
  read_field(grid, vtkhdf::points, index * n, frame);
  for (const vtkhdf::Field& f : vtkhdf::fields) read_field(data, f, index * n, frame);
  return frame;
}

}  // namespace talus
