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

/// The integer lists with one number a step, and the numbers of the step whose particles begin at row `offset`. There
/// is one grid with one topology, so that the offsets of its parts and cells stay 0. The group talus is not VTK's.
std::vector<std::pair<std::string, std::int64_t>> step_numbers(std::int64_t offset, std::int64_t step) {
  std::vector<std::pair<std::string, std::int64_t>> all = {{"talus/step", step},
                                                           {"VTKHDF/Steps/NumberOfParts", 1},
                                                           {"VTKHDF/Steps/PartOffsets", 0},
                                                           {"VTKHDF/Steps/CellOffsets", 0},
                                                           {"VTKHDF/Steps/ConnectivityIdOffsets", 0},
                                                           {"VTKHDF/Steps/PointOffsets", offset}};
  const std::string group = "VTKHDF/Steps/PointDataOffsets/";
  for (const Field& f : std::span(fields).subspan(1)) all.emplace_back(group + f.name(), offset);
  for (const char* name : constant_fields) all.emplace_back(group + name, 0);
  return all;
}

constexpr const char* step_times = "VTKHDF/Steps/Values";

}  // namespace

void write_grid(hid_t root, std::size_t n, std::array<std::int64_t, 2> version) {
  const hdf5::Id grid = hdf5::create_group(root, "VTKHDF");
  hdf5::write_attribute_list<std::int64_t>(grid, "Version", version);
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
  write_grid(root, n, temporal_version);
  for (const char* group : {"VTKHDF/PointData", "VTKHDF/Steps", "VTKHDF/Steps/PointDataOffsets", "talus"})
    hdf5::create_group(root, group);
  for (const Field& f : fields)
    hdf5::create_rows(root, f.path, hdf5::type<float>(), static_cast<std::size_t>(f.components), std::min(n, max_chunk),
                      Filter::compressed);
  std::vector<std::int32_t> numbers(n);
  std::iota(numbers.begin(), numbers.end(), 0);
  hdf5::write_array<std::int32_t>(root, "VTKHDF/PointData/id", numbers, Filter::compressed);
  for (std::size_t i = 0; i < n; ++i) numbers[i] = i < first.n_soil ? 0 : 1;
  hdf5::write_array<std::int32_t>(root, "VTKHDF/PointData/is_wall", numbers, Filter::compressed);
  hdf5::write_attribute<std::int64_t>(hdf5::open_group(root, "VTKHDF/Steps"), "NSteps", 0);
  hdf5::create_rows(root, step_times, hdf5::type<double>(), 1, steps_per_chunk);
  for (const auto& [path, number] : step_numbers(0, 0))
    hdf5::create_rows(root, path, hdf5::type<std::int64_t>(), 1, steps_per_chunk);
}

void append_step(hid_t root, const Frame& frame, std::size_t step) {
  const std::size_t n = frame.position.size();
  std::vector<float> buffer;
  for (const Field& f : fields) {
    const auto components = static_cast<std::size_t>(f.components);
    buffer.resize(n * components);
    for (std::size_t i = 0; i < n; ++i) f.get(frame, i, &buffer[i * components]);
    hdf5::append_rows<float>(root, f.path, buffer);
  }
  for (const auto& [path, number] : step_numbers(static_cast<std::int64_t>(step * n), frame.step))
    hdf5::append_rows<std::int64_t>(root, path, {{number}});
  hdf5::append_rows<double>(root, step_times, {{frame.time}});
}

void commit(hid_t root, std::size_t steps) {
  hdf5::write_attribute(hdf5::open_group(root, "VTKHDF/Steps"), "NSteps", static_cast<std::int64_t>(steps));
}

void truncate_steps(hid_t root, std::size_t steps, std::size_t n) {
  for (const Field& f : fields) hdf5::truncate_rows(root, f.path, steps * n);
  for (const auto& [path, number] : step_numbers(0, 0)) hdf5::truncate_rows(root, path, steps);
  hdf5::truncate_rows(root, step_times, steps);
}

}  // namespace talus::vtkhdf
