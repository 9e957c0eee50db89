#pragma once
// The part of HDF5 that Talus needs, with owners for its identifiers and IoError for its error codes. API of 1.10 and
// of 1.14. Not thread-safe: the library must be called from one thread at a time.

#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace talus::hdf5 {

/// Throws IoError "<what>: <HDF5's own reason>".
[[noreturn]] void fail(const std::string& what);

/// Owns an identifier and closes it when destroyed.
class Id {
 public:
  using Close = herr_t (*)(hid_t);
  Id() = default;
  /// @throws IoError saying `what` went wrong when `id` is not valid
  Id(hid_t id, Close closer, const std::string& what) : id_(id), close_(closer) {
    if (id < 0) fail(what);
  }
  Id(Id&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Id& operator=(Id&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Id() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }
  bool valid() const { return id_ >= 0; }
  /// Closes now. @return HDF5's code, < 0 on failure
  herr_t close() { return id_ < 0 ? 0 : close_(std::exchange(id_, -1)); }

 private:
  hid_t id_ = -1;
  Close close_ = nullptr;
};

/// Files carry no time stamps, so that the same content gives the same bytes, and take no locks (OutputDirectory
/// has one; and a viewer may look at a file while it grows). HDF5 prints nothing.
/// @{
Id create_in_memory();
/// @param name  for messages; the name of a file or one that does not exist
Id open_image(std::string_view image, const std::string& name);
enum class Access { read, read_write };
Id open_file(const std::filesystem::path& path, Access access);
/// The bytes of an open file, as they would lie on the disk.
std::string image(const Id& file);
/// Flushes everything to the operating system. @throws IoError
void flush(const Id& file);
/// @}

Id create_group(hid_t parent, const std::string& name);
Id open_group(hid_t parent, const std::string& name);
bool has(hid_t parent, const std::string& name);
/// Names of the links in a group, in alphabetical order.
std::vector<std::string> names(hid_t group);

// T below is double, float, std::int32_t, std::int64_t, std::uint64_t or std::uint8_t; files are little-endian on every
// machine.

/// An array of fixed size; `compressed` means shuffle and gzip.
enum class Filter { none, compressed };
template <class T>
void write_array(hid_t parent, const std::string& name, std::span<const T> values, Filter filter = Filter::none,
                 std::size_t components = 1);

/// The whole array, rows one after the other.
template <class T>
std::vector<T> read_array(hid_t parent, const std::string& name);

/// An array of rows that can grow: creates it empty.
/// @param components     numbers in a row; 1 makes the array one-dimensional
/// @param rows_per_chunk >= 1
template <class T>
void create_rows(hid_t parent, const std::string& name, std::size_t components, std::size_t rows_per_chunk,
                 Filter filter = Filter::none);
/// Appends `values.size() / components` rows.
template <class T>
void append_rows(hid_t parent, const std::string& name, std::span<const T> values);
/// Rows first .. first + count - 1, one after the other. @throws IoError where the array has fewer
template <class T>
std::vector<T> read_rows(hid_t parent, const std::string& name, std::size_t first, std::size_t count);
/// Cuts the array to its first `rows` rows. @throws IoError where it has fewer
void truncate_rows(hid_t parent, const std::string& name, std::size_t rows);

/// Attributes: a scalar, a small array, or a fixed-length ASCII string. Writing over an attribute of the same type
/// replaces its value.
/// @{
template <class T>
void write_attribute(hid_t object, const std::string& name, T value);
template <class T>
T read_attribute(hid_t object, const std::string& name);
template <class T>
void write_attribute_array(hid_t object, const std::string& name, std::span<const T> values);
void write_text_attribute(hid_t object, const std::string& name, const std::string& text);
std::string read_text_attribute(hid_t object, const std::string& name);
bool has_attribute(hid_t object, const std::string& name);
/// @}

}  // namespace talus::hdf5
