#include <algorithm>
#include <cstdint>
#include <stdexcept>

#include "io/history.hpp"
#include "io/vtkhdf.hpp"
#include "io/vtkhdf_layout.hpp"
#include "support/files.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

constexpr std::array<std::int64_t, 2> single_time_version = {1, 0};

void check_lengths(std::span<const Vec2> positions, std::span<const NamedArray> arrays) {
  for (const NamedArray& a : arrays)
    if (a.values.size() != positions.size())
      throw std::invalid_argument("points: array " + a.name + " has another length than the positions");
}

}  // namespace

void write_points(const std::filesystem::path& path, std::span<const Vec2> positions,
                  std::span<const NamedArray> arrays) {
  check_lengths(positions, arrays);
  const hdf5::Id file = hdf5::create_in_memory();
  vtkhdf::write_grid(file, positions.size(), single_time_version);
  const hdf5::Id grid = hdf5::open_group(file, "VTKHDF");
  std::vector<double> xyz;
  for (const Vec2 p : positions) xyz.insert(xyz.end(), {p.x, p.y, 0.0});
  hdf5::write_array<double>(grid, "Points", xyz, hdf5::Filter::compressed, 3);
  const hdf5::Id data = hdf5::create_group(grid, "PointData");
  for (const NamedArray& a : arrays) hdf5::write_array<double>(data, a.name, a.values, hdf5::Filter::compressed);
  write_file_atomically(path, hdf5::image(file));
}

void write_field_csv(const std::filesystem::path& path, std::span<const Vec2> positions,
                     std::span<const NamedArray> arrays) {
  check_lengths(positions, arrays);
  std::string text = "x_m,y_m";
  for (const NamedArray& a : arrays) text += "," + a.name;
  text += "\n";
  for (std::size_t i = 0; i < positions.size(); ++i) {
    text += to_text(positions[i].x) + "," + to_text(positions[i].y);
    for (const NamedArray& a : arrays) text += "," + to_text(a.values[i]);
    text += "\n";
  }
  write_file_atomically(path, text);
}

}  // namespace talus
