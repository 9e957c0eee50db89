#include "io/vtkhdf_layout.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace talus::vtkhdf {
namespace {

using hdf5::Filter;

constexpr std::array<std::int64_t, 2> temporal_version = {2, 0};  ///< VTK 9.3 is the first to read it
constexpr std::size_t steps_per_chunk = 64;

/// Integer lists of the group Steps, one number a step: the first four never change since there is one grid with one
/// topology.
constexpr std::array<std::pair<const char*, std::int64_t>, 4> constant_steps = {
    {{"NumberOfParts", 1}, {"PartOffsets", 0}, {"CellOffsets", 0}, {"ConnectivityIdOffsets", 0}}};

void append_field(hid_t group, const Field& field, const Frame& frame, std::vector<float>& buffer) {
  const std::size_t n = frame.position.size();
  const auto components = static_cast<std::size_t>(field.components);
  buffer.resize(n * components);
  for (std::size_t i = 0; i < n; ++i) field.get(frame, i, &buffer[i * components]);
  hdf5::append_rows<float>(group, field.name, buffer);
}

void append_number(hid_t group, const char* name, std::int64_t value) {
  hdf5::append_rows<std::int64_t>(group, name, {{value}});
}

}  // namespace

void write_grid(hid_t root, std::size_t n, std::array<std::int64_t, 2> version) {
  const hdf5::Id grid = hdf5::create_group(root, "VTKHDF");
  hdf5::write_attribute_array<std::int64_t>(grid, "Version", version);
  hdf5::write_text_attribute(grid, "Type", "UnstructuredGrid");
  const auto count = static_cast<std::int64_t>(n);
  for (const char* name : {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"})
    hdf5::write_array<std::int64_t>(grid, name, {{count}});
  std::vector<std::int64_t> numbers(n + 1);
  std::iota(numbers.begin(), numbers.end(), 0);
  hdf5::write_array<std::int64_t>(grid, "Offsets", numbers, Filter::compressed);
  numbers.pop_back();
  hdf5::write_array<std::int64_t>(grid, "Connectivity", numbers, Filter::compressed);
  constexpr std::uint8_t vertex = 1;  // VTK_VERTEX
  hdf5::write_array<std::uint8_t>(grid, "Types", std::vector<std::uint8_t>(n, vertex), Filter::compressed);
}

void create_skeleton(hid_t root, const Frame& first) {
  const std::size_t n = first.position.size();
  const std::size_t chunk = std::min(n, max_chunk);
  write_grid(root, n, temporal_version);
  const hdf5::Id grid = hdf5::open_group(root, "VTKHDF");
  hdf5::create_rows<float>(grid, "Points", 3, chunk, Filter::compressed);

  const hdf5::Id data = hdf5::create_group(grid, "PointData");
  for (const Field& f : fields)
    hdf5::create_rows<float>(data, f.name, static_cast<std::size_t>(f.components), chunk, Filter::compressed);
  std::vector<std::int32_t> numbers(n);
  std::iota(numbers.begin(), numbers.end(), 0);
  hdf5::write_array<std::int32_t>(data, id, numbers, Filter::compressed);
  const auto n_soil = static_cast<std::int32_t>(first.n_soil);
  std::transform(numbers.begin(), numbers.end(), numbers.begin(),
                 [n_soil](std::int32_t i) { return i < n_soil ? 0 : 1; });
  hdf5::write_array<std::int32_t>(data, is_wall, numbers, Filter::compressed);

  const hdf5::Id steps = hdf5::create_group(grid, "Steps");
  hdf5::write_attribute<std::int64_t>(steps, "NSteps", 0);
  hdf5::create_rows<double>(steps, "Values", 1, steps_per_chunk);
  hdf5::create_rows<std::int64_t>(steps, "PointOffsets", 1, steps_per_chunk);
  for (const auto& [name, value] : constant_steps) hdf5::create_rows<std::int64_t>(steps, name, 1, steps_per_chunk);
  const hdf5::Id offsets = hdf5::create_group(steps, "PointDataOffsets");
  for (const Field& f : fields) hdf5::create_rows<std::int64_t>(offsets, f.name, 1, steps_per_chunk);
  for (const char* name : constant_fields) hdf5::create_rows<std::int64_t>(offsets, name, 1, steps_per_chunk);

  const hdf5::Id own = hdf5::create_group(root, own_group);
  hdf5::create_rows<std::int64_t>(own, "step", 1, steps_per_chunk);
}

void append_step(hid_t root, const Frame& frame, std::size_t step) {
  const auto offset = static_cast<std::int64_t>(step * frame.position.size());
  const hdf5::Id grid = hdf5::open_group(root, "VTKHDF");
  const hdf5::Id data = hdf5::open_group(grid, "PointData");
  const hdf5::Id steps = hdf5::open_group(grid, "Steps");
  const hdf5::Id offsets = hdf5::open_group(steps, "PointDataOffsets");
  const hdf5::Id own = hdf5::open_group(root, own_group);
  std::vector<float> buffer;
  append_field(grid, points, frame, buffer);
  for (const Field& f : fields) {
    append_field(data, f, frame, buffer);
    append_number(offsets, f.name, offset);
  }
  for (const char* name : constant_fields) append_number(offsets, name, 0);
  for (const auto& [name, value] : constant_steps) append_number(steps, name, value);
  append_number(steps, "PointOffsets", offset);
  append_number(own, "step", frame.step);
  hdf5::append_rows<double>(steps, "Values", {{frame.time}});
}

void commit(hid_t root, std::size_t steps) {
  hdf5::write_attribute<std::int64_t>(hdf5::open_group(root, "VTKHDF/Steps"), "NSteps",
                                      static_cast<std::int64_t>(steps));
}

void truncate_steps(hid_t root, std::size_t steps, std::size_t n) {
  const hdf5::Id grid = hdf5::open_group(root, "VTKHDF");
  const hdf5::Id data = hdf5::open_group(grid, "PointData");
  const hdf5::Id lists = hdf5::open_group(grid, "Steps");
  const hdf5::Id offsets = hdf5::open_group(lists, "PointDataOffsets");
  hdf5::truncate_rows(grid, "Points", steps * n);
  for (const Field& f : fields) {
    hdf5::truncate_rows(data, f.name, steps * n);
    hdf5::truncate_rows(offsets, f.name, steps);
  }
  for (const char* name : constant_fields) hdf5::truncate_rows(offsets, name, steps);
  for (const auto& [name, value] : constant_steps) hdf5::truncate_rows(lists, name, steps);
  hdf5::truncate_rows(lists, "PointOffsets", steps);
  hdf5::truncate_rows(hdf5::open_group(root, own_group), "step", steps);
  hdf5::truncate_rows(lists, "Values", steps);
}

}  // namespace talus::vtkhdf
