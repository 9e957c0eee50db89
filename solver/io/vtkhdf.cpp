#include "io/vtkhdf.hpp"

#include <fcntl.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <stdexcept>

#include "io/vtkhdf_layout.hpp"
#include "io/xdmf.hpp"
#include "support/error.hpp"
#include "support/files.hpp"

namespace talus {
namespace {

namespace fs = std::filesystem;

void check_lengths(const Frame& f) {
  const std::size_t n = f.position.size();
  const std::size_t lengths[] = {f.displacement.size(), f.velocity.size(),   f.density.size(), f.pressure.size(),
                                 f.tan_phi.size(),      f.shear_rate.size(), f.stress.size()};
  if (n == 0 || f.n_soil > n ||
      std::any_of(std::begin(lengths), std::end(lengths), [n](std::size_t m) { return m != n; }))
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
    std::size_t numbers_per_row = 3;
    for (const vtkhdf::Field& f : vtkhdf::fields) numbers_per_row += static_cast<std::size_t>(f.components);
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

}  // namespace

SnapshotWriter::SnapshotWriter(fs::path path, hdf5::Id file) : path_(std::move(path)), file_(std::move(file)) {}

SnapshotWriter::SnapshotWriter(fs::path path, const Frame& first)
    : path_(std::move(path)), times_{first.time}, particles_(first.position.size()) {
  check_lengths(first);
  {
    const hdf5::Id memory = hdf5::create_in_memory();
    vtkhdf::create_skeleton(memory, first);
    vtkhdf::append_step(memory, first, 0);
    vtkhdf::commit(memory, 1);
    write_file_atomically(path_, hdf5::image(memory));
  }
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
  hdf5::flush(file_);
  hsize_t size = 0;
  if (H5Fget_filesize(file_, &size) < 0) hdf5::fail("cannot write " + path_.string());
  reserve.release(size);
  times_.push_back(frame.time);
  write_sidecar();
}

void SnapshotWriter::close() {
  if (file_.close() < 0) hdf5::fail("cannot write " + path_.string());
}

void SnapshotWriter::write_sidecar() const {
  write_file_atomically(fs::path(path_).replace_extension(".xdmf"),
                        xdmf_document(path_.filename().string(), particles_, times_));
}

}  // namespace talus
