#include "io/vtkhdf.hpp"

#include <fcntl.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <stdexcept>

#include "io/vtkhdf_layout.hpp"
#include "support/error.hpp"
#include "support/files.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

namespace fs = std::filesystem;

void check_lengths(const Frame& f) {
  const std::size_t n = f.position.size();
  const auto all_equal = [n](const auto&... array) { return ((array.size() == n) && ...); };
  const auto fits = [&](const vtkhdf::OptionalField& optional) {
    return (f.*optional.array).empty() || (f.*optional.array).size() == n;
  };
  if (n == 0 || f.n_soil > n || !std::apply(all_equal, vtkhdf::arrays_of(f)) ||
      !std::ranges::all_of(vtkhdf::optional_fields, fits))
    throw std::invalid_argument("snapshot: the frame is empty or its arrays differ in length");
}

/// Makes the file longer than a step can make it, before HDF5 touches it, and cuts off what is left over afterwards. So
/// a full disk is noticed while the file is still as it was, and HDF5 never finds its file shorter than it should be,
/// whenever the process is killed.
class Reserve {
 public:
  Reserve(const fs::path& path, std::size_t particles)
      : path_(path), file_(::open(path.c_str(), O_WRONLY | O_CLOEXEC)) {
    if (!file_) throw_io_error("write", path_, errno);
    std::size_t numbers_per_row = 3;  // points of double precision take six
    for (const vtkhdf::Field& f : vtkhdf::fields) numbers_per_row += static_cast<std::size_t>(f.components);
    numbers_per_row += vtkhdf::optional_fields.size();
    const std::size_t rows = particles + 2 * std::min(particles, vtkhdf::max_chunk);  // a chunk that grows may move
    constexpr std::size_t metadata = 128 * 1024;
    const auto bytes = static_cast<off_t>(rows * numbers_per_row * sizeof(float) + metadata);
    old_size_ = ::lseek(file_.get(), 0, SEEK_END);
    int result;
    do result = ::fallocate(file_.get(), 0, old_size_, bytes);
    while (result != 0 && errno == EINTR);
    if (result != 0 && errno != EOPNOTSUPP) {  // a file system that cannot reserve does without
      const int error = errno;
      cut(old_size_);
      throw_io_error("write", path_, error);
    }
  }
  Reserve(const Reserve&) = delete;
  Reserve& operator=(const Reserve&) = delete;

  /// Cuts the file to its `size` bytes and waits until they are on the disk.
  void release(hsize_t size) {
    if (cut(static_cast<off_t>(size)) != 0 || ::fsync(file_.get()) != 0) throw_io_error("write", path_, errno);
  }

 private:
  int cut(off_t size) const { return ::ftruncate(file_.get(), size); }

  fs::path path_;
  FileDescriptor file_;
  off_t old_size_ = 0;
};

hdf5::Id open_snapshots(const fs::path& path) {
  hdf5::Id file = hdf5::open_file(path, hdf5::Access::read);
  if (!hdf5::has(file, "VTKHDF") || !hdf5::has(file, "talus"))
    throw IoError(path.string() + " is not a file of snapshots of Talus");
  return file;
}

std::vector<double> times_of(const hdf5::Id& file) {
  const hdf5::Id steps = hdf5::open_group(file, "VTKHDF/Steps");
  const auto count = hdf5::read_attribute<std::int64_t>(steps, "NSteps");
  return hdf5::read_rows<double>(steps, "Values", 0, static_cast<std::size_t>(std::max<std::int64_t>(count, 0)));
}

/// Whether the snapshots are of a case in local coordinates.
bool has_origin(const hdf5::Id& file) {
  return hdf5::has_attribute(hdf5::open_group(file, "VTKHDF"), vtkhdf::origin_attributes[0]);
}

void check_lengths(std::span<const Vec2> positions, std::span<const NamedArray> arrays) {
  for (const NamedArray& a : arrays)
    if (a.values.size() != positions.size())
      throw std::invalid_argument("points: array " + a.name + " has another length than the positions");
}

}  // namespace

SnapshotWriter::SnapshotWriter(fs::path path, hdf5::Id file) : path_(std::move(path)), file_(std::move(file)) {}

SnapshotWriter::SnapshotWriter(fs::path path, const Frame& first, const std::optional<Provenance>& provenance)
    : path_(std::move(path)), times_{first.time}, particles_(first.position.size()), far_(first.origin != Vec2{}) {
  check_lengths(first);
  const hdf5::Id memory = hdf5::create_in_memory();
  vtkhdf::create_skeleton(memory, first);
  if (provenance) vtkhdf::write_provenance(memory, *provenance);
  vtkhdf::append_step(memory, first, 0);
  vtkhdf::commit(memory, 1);
  write_file_atomically(path_, hdf5::image(memory));
  file_ = hdf5::open_file(path_, hdf5::Access::read_write);
  write_sidecar();
}

SnapshotWriter SnapshotWriter::resume(fs::path path, double time) {
  std::vector<double> times = snapshot_times(path);
  times.erase(std::upper_bound(times.begin(), times.end(), time), times.end());
  SnapshotWriter writer(path, hdf5::open_file(path, hdf5::Access::read_write));
  const auto n = hdf5::read_array<std::int64_t>(writer.file_, "VTKHDF/NumberOfPoints");
  if (n.size() != 1 || n[0] < 1) throw IoError(path.string() + " is not a file of snapshots of Talus");
  writer.particles_ = static_cast<std::size_t>(n[0]);
  writer.far_ = has_origin(writer.file_);
  writer.times_ = std::move(times);
  vtkhdf::commit(writer.file_, writer.times_.size());
  hdf5::flush(writer.file_);
  vtkhdf::truncate_steps(writer.file_, writer.times_.size(), writer.particles_);
  hdf5::flush(writer.file_);
  writer.write_sidecar();
  return writer;
}

void SnapshotWriter::append(const Frame& frame) {
  check_lengths(frame);
  if (frame.position.size() != particles_) throw std::invalid_argument("snapshot: the number of particles has changed");
  if (!times_.empty() && frame.time == times_.back()) return;
  if (!times_.empty() && !(frame.time > times_.back()))
    throw std::invalid_argument("snapshot: the frame is earlier than the last one");
  Reserve reserve(path_, particles_);
  vtkhdf::append_step(file_, frame, times_.size());
  hdf5::flush(file_);
  vtkhdf::commit(file_, times_.size() + 1);
  reserve.release(hdf5::flush(file_));
  times_.push_back(frame.time);
  write_sidecar();
}

void SnapshotWriter::close() {
  if (file_.close() < 0) hdf5::fail("cannot write " + path_.string());
}

void SnapshotWriter::write_sidecar() const {
  write_file_atomically(
      fs::path(path_).replace_extension(".xdmf"),
      vtkhdf::xdmf_document(path_.filename().string(), particles_, times_, far_, vtkhdf::fields_of(file_)));
}

std::vector<double> snapshot_times(const fs::path& path) { return times_of(open_snapshots(path)); }

Frame read_frame(const fs::path& path, std::size_t index) {
  const hdf5::Id file = open_snapshots(path);
  const std::vector<double> times = times_of(file);
  if (index >= times.size())
    throw IoError(path.string() + " has " + std::to_string(times.size()) + " steps; there is no step " +
                  std::to_string(index));
  const auto walls = hdf5::read_array<std::int32_t>(file, "VTKHDF/PointData/is_wall");
  const std::size_t n = walls.size();

  Frame frame;
  frame.time = times[index];
  frame.step = hdf5::read_rows<std::int64_t>(file, "talus/step", index, 1)[0];
  if (has_origin(file)) {
    const hdf5::Id grid = hdf5::open_group(file, "VTKHDF");
    frame.origin = {hdf5::read_attribute<double>(grid, vtkhdf::origin_attributes[0]),
                    hdf5::read_attribute<double>(grid, vtkhdf::origin_attributes[1])};
  }
  frame.n_soil = static_cast<std::size_t>(std::count(walls.begin(), walls.end(), 0));
  std::apply([n](auto&... array) { (array.resize(n), ...); }, vtkhdf::arrays_of(frame));
  const std::vector<vtkhdf::Field> arrays = vtkhdf::fields_of(file);
  for (const vtkhdf::OptionalField& optional : vtkhdf::optional_fields)
    if (std::ranges::count(arrays, optional.field.name(), &vtkhdf::Field::name) > 0) (frame.*optional.array).resize(n);
  for (const vtkhdf::Field& f : arrays) {
    const auto components = static_cast<std::size_t>(f.components);
    const std::vector<float> values = hdf5::read_rows<float>(file, f.path, index * n, n);
    if (values.size() != n * components)
      throw IoError("the snapshots' array " + f.name() + " has another shape than expected");
    for (std::size_t i = 0; i < n; ++i) f.set(frame, i, &values[i * components]);
  }
  if (frame.origin != Vec2{}) {
    const std::vector<double> xyz = hdf5::read_rows<double>(file, vtkhdf::points.path, index * n, n);
    for (std::size_t i = 0; i < n; ++i) frame.position[i] = Vec2{xyz[3 * i], xyz[3 * i + 1]} - frame.origin;
  }
  return frame;
}

void write_points(const std::filesystem::path& path, std::span<const Vec2> positions,
                  std::span<const NamedArray> arrays) {
  check_lengths(positions, arrays);
  const hdf5::Id file = hdf5::create_in_memory();
  vtkhdf::write_grid(file, positions.size(), {1, 0});  // version 1.0: a single time
  std::vector<double> xyz;
  for (const Vec2 p : positions) xyz.insert(xyz.end(), {p.x, p.y, 0.0});
  hdf5::write_array<double>(file, "VTKHDF/Points", xyz, hdf5::Filter::compressed, 3);
  const hdf5::Id data = hdf5::create_group(file, "VTKHDF/PointData");
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
