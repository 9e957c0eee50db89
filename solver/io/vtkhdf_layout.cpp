#include "io/vtkhdf_layout.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "support/text.hpp"

namespace talus::vtkhdf {
namespace {

using hdf5::Filter;

constexpr std::array<std::int64_t, 2> temporal_version = {2, 0};  ///< VTK 9.3 is the first to read it
constexpr std::size_t steps_per_chunk = 64;

/// The integer lists with one number a step, and the numbers of the step whose particles begin at row `offset`. There
/// is one grid with one topology, so that the offsets of its parts and cells stay 0. The group talus is not VTK's.
std::vector<std::pair<std::string, std::int64_t>> step_numbers(std::span<const Field> arrays, std::int64_t offset,
                                                               std::int64_t step) {
  std::vector<std::pair<std::string, std::int64_t>> all = {{"talus/step", step},
                                                           {"VTKHDF/Steps/NumberOfParts", 1},
                                                           {"VTKHDF/Steps/PartOffsets", 0},
                                                           {"VTKHDF/Steps/CellOffsets", 0},
                                                           {"VTKHDF/Steps/ConnectivityIdOffsets", 0},
                                                           {"VTKHDF/Steps/PointOffsets", offset}};
  const std::string group = "VTKHDF/Steps/PointDataOffsets/";
  for (const Field& f : arrays.subspan(1)) all.emplace_back(group + f.name(), offset);
  for (const char* name : constant_fields) all.emplace_back(group + name, 0);
  return all;
}

constexpr const char* step_times = "VTKHDF/Steps/Values";

/// Columns first .. first + count - 1 of `rows` rows of an array in the file.
struct Slab {
  std::string path;
  const char* number;      ///< XDMF's name of the type
  std::size_t array_rows;  ///< of the whole array
  int array_columns;
  std::size_t first_row;
  std::size_t rows;
  int first_column;
  int columns;
  int bytes = 4;  ///< of a number
};

std::string item(const std::string& file, const Slab& s) {
  const bool table = s.array_columns > 1;
  const auto numbers = [table](std::size_t a, int b) {
    return table ? std::to_string(a) + " " + std::to_string(b) : std::to_string(a);
  };
  return "<DataItem ItemType=\"HyperSlab\" Dimensions=\"" +
         (s.columns > 1 ? numbers(s.rows, s.columns) : std::to_string(s.rows)) + "\"><DataItem Dimensions=\"3 " +
         (table ? "2" : "1") + "\" Format=\"XML\" NumberType=\"Int\">" + numbers(s.first_row, s.first_column) + " " +
         numbers(1, 1) + " " + numbers(s.rows, s.columns) + "</DataItem><DataItem Dimensions=\"" +
         numbers(s.array_rows, s.array_columns) + "\" NumberType=\"" + s.number + "\" Precision=\"" +
         std::to_string(s.bytes) + "\" Format=\"HDF\">" + file + ":" + s.path + "</DataItem></DataItem>";
}

std::string attribute(const std::string& name, bool vector, const std::string& data) {
  return "<Attribute Name=\"" + name + "\" AttributeType=\"" + (vector ? "Vector" : "Scalar") + "\" Center=\"Node\">" +
         data + "</Attribute>\n";
}

/// Single precision would lose the decimetres of a national grid.
void append_far_points(hid_t root, const Frame& frame) {
  std::vector<double> xyz;
  for (const Vec2& x : frame.position) xyz.insert(xyz.end(), {x.x + frame.origin.x, x.y + frame.origin.y, 0.0});
  hdf5::append_rows<double>(root, points.path, xyz);
}

void write_units(hid_t root, const std::string& path, const char* unit) {
  hdf5::write_text_attribute(hdf5::open_array(root, path), units_attribute, unit);
}

bool is_points(const Field& f) { return std::string_view(f.path) == points.path; }

}  // namespace

std::vector<Field> fields_of(const Frame& frame) {
  std::vector<Field> all(fields.begin(), fields.end());
  for (const OptionalField& optional : optional_fields)
    if (!(frame.*optional.array).empty()) all.push_back(optional.field);
  return all;
}

std::vector<Field> fields_of(hid_t root) {
  std::vector<Field> all(fields.begin(), fields.end());
  const hdf5::Id data = hdf5::open_group(root, "VTKHDF/PointData");
  for (const OptionalField& optional : optional_fields)
    if (hdf5::has(data, optional.field.name())) all.push_back(optional.field);
  return all;
}

void write_provenance(hid_t root, const Provenance& provenance) {
  const hdf5::Id group = hdf5::open_group(root, "talus");
  hdf5::write_text_attribute(group, title_attribute, provenance.case_title);
  hdf5::write_text_attribute(group, version_attribute, provenance.version);
  hdf5::write_text_attribute(group, case_hash_attribute, provenance.case_hash);
  hdf5::write_attribute<std::uint64_t>(group, seed_attribute, provenance.seed);
  if (provenance.realization)
    hdf5::write_attribute<std::int64_t>(group, realization_attribute, *provenance.realization);
  if (provenance.perturbation) hdf5::write_attribute<double>(group, perturbation_attribute, *provenance.perturbation);
}

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
  const bool far = first.origin != Vec2{};
  if (far) {
    const hdf5::Id grid = hdf5::open_group(root, "VTKHDF");
    hdf5::write_attribute<double>(grid, origin_attributes[0], first.origin.x);
    hdf5::write_attribute<double>(grid, origin_attributes[1], first.origin.y);
  }
  for (const char* group : {"VTKHDF/PointData", "VTKHDF/Steps", "VTKHDF/Steps/PointDataOffsets", "talus"})
    hdf5::create_group(root, group);
  const std::vector<Field> arrays = fields_of(first);
  for (const Field& f : arrays)
    hdf5::create_rows(root, f.path, far && is_points(f) ? hdf5::type<double>() : hdf5::type<float>(),
                      static_cast<std::size_t>(f.components), std::min(n, max_chunk), Filter::compressed);
  for (const Field& f : arrays) write_units(root, f.path, f.unit);
  std::vector<std::int32_t> numbers(n);
  std::iota(numbers.begin(), numbers.end(), 0);
  hdf5::write_array<std::int32_t>(root, "VTKHDF/PointData/id", numbers, Filter::compressed);
  for (std::size_t i = 0; i < n; ++i) numbers[i] = i < first.n_soil ? 0 : 1;
  hdf5::write_array<std::int32_t>(root, "VTKHDF/PointData/is_wall", numbers, Filter::compressed);
  for (const char* name : constant_fields) write_units(root, std::string("VTKHDF/PointData/") + name, "1");
  hdf5::write_attribute<std::int64_t>(hdf5::open_group(root, "VTKHDF/Steps"), "NSteps", 0);
  hdf5::create_rows(root, step_times, hdf5::type<double>(), 1, steps_per_chunk);
  write_units(root, step_times, "s");
  for (const auto& [path, number] : step_numbers(arrays, 0, 0))
    hdf5::create_rows(root, path, hdf5::type<std::int64_t>(), 1, steps_per_chunk);
}

void append_step(hid_t root, const Frame& frame, std::size_t step) {
  const std::size_t n = frame.position.size();
  std::vector<float> buffer;
  const std::vector<Field> arrays = fields_of(frame);
  for (const Field& f : arrays) {
    if (is_points(f) && frame.origin != Vec2{}) {
      append_far_points(root, frame);
      continue;
    }
    const auto components = static_cast<std::size_t>(f.components);
    buffer.resize(n * components);
    for (std::size_t i = 0; i < n; ++i) f.get(frame, i, &buffer[i * components]);
    hdf5::append_rows<float>(root, f.path, buffer);
  }
  for (const auto& [path, number] : step_numbers(arrays, static_cast<std::int64_t>(step * n), frame.step))
    hdf5::append_rows<std::int64_t>(root, path, {{number}});
  hdf5::append_rows<double>(root, step_times, {{frame.time}});
}

void commit(hid_t root, std::size_t steps) {
  hdf5::write_attribute(hdf5::open_group(root, "VTKHDF/Steps"), "NSteps", static_cast<std::int64_t>(steps));
}

void truncate_steps(hid_t root, std::size_t steps, std::size_t n) {
  const std::vector<Field> arrays = fields_of(root);
  for (const Field& f : arrays) hdf5::truncate_rows(root, f.path, steps * n);
  for (const auto& [path, number] : step_numbers(arrays, 0, 0)) hdf5::truncate_rows(root, path, steps);
  hdf5::truncate_rows(root, step_times, steps);
}

std::string xdmf_document(const std::string& file, std::size_t n, std::span<const double> times, bool far,
                          std::span<const Field> arrays) {
  const std::size_t rows = n * times.size();
  std::string text =
      "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\"><Domain><Grid Name=\"snapshots\" GridType=\"Collection\" "
      "CollectionType=\"Temporal\">\n";
  for (std::size_t k = 0; k < times.size(); ++k) {
    const auto whole = [&](const Field& f) {
      return item(file, {"/" + std::string(f.path), "Float", rows, f.components, k * n, n, 0, f.components,
                         far && is_points(f) ? 8 : 4});
    };
    text += "<Grid Name=\"step" + std::to_string(k) + "\" GridType=\"Uniform\"><Time Value=\"" + to_text(times[k]) +
            "\"/><Topology TopologyType=\"Polyvertex\" NumberOfElements=\"" + std::to_string(n) +
            "\" NodesPerElement=\"1\"/>\n" + "<Geometry GeometryType=\"XYZ\">" + whole(points) + "</Geometry>\n";
    for (const Field& f : arrays.subspan(1))
      if (f.components <= 3) text += attribute(f.name(), f.components == 3, whole(f));
    const std::string point_data = "/VTKHDF/PointData/";
    const char* const components[] = {"stress_xx", "stress_yy", "stress_zz", "stress_xy"};
    for (int c = 0; c < 4; ++c)
      text += attribute(components[c], false, item(file, {point_data + "stress", "Float", rows, 6, k * n, n, c, 1}));
    for (const char* name : constant_fields)
      text += attribute(name, false, item(file, {point_data + name, "Int", n, 1, 0, n, 0, 1}));
    text += "</Grid>\n";
  }
  return text + "</Grid></Domain></Xdmf>\n";
}

}  // namespace talus::vtkhdf
