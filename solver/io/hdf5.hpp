#pragma once
// The part of HDF5 that Talus needs, with owners for its identifiers and IoError for its error codes. API of 1.10 and
// of 1.14. Not thread-safe: the library must be called from one thread at a time.

#include <hdf5.h>

#include <bit>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace talus::hdf5 {

/// Throws IoError "<what>: <HDF5's own reason>".
[[noreturn]] void fail(const std::string& what);

/// Owns an identifier and closes it when destroyed.
class Id {
 public:
  Id() = default;
  /// @throws IoError as fail() does when `id` is not valid
  Id(hid_t id, const std::string& what) : id_(id) {
    if (id < 0) fail(what);
  }
  Id(Id&& other) noexcept : id_(std::exchange(other.id_, -1)) {}
  Id& operator=(Id&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~Id() { close(); }
  operator hid_t() const { return id_; }
  /// Closes now. @return HDF5's code, < 0 on failure
  herr_t close() { return id_ < 0 ? 0 : H5Idec_ref(std::exchange(id_, -1)); }

 private:
  hid_t id_ = -1;
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
/// Flushes everything to the operating system. @return the size of the file [bytes]. @throws IoError
hsize_t flush(const Id& file);
/// @}

Id create_group(hid_t parent, const std::string& name);
Id open_group(hid_t parent, const std::string& name);
Id open_array(hid_t parent, const std::string& name);
bool has(hid_t parent, const std::string& name);
/// Names of the links in a group, in alphabetical order.
std::vector<std::string> names(hid_t group);

/// The HDF5 type of T, in memory and in files: both are little-endian.
template <class T>
hid_t type() {
  static_assert(std::endian::native == std::endian::little);
  if constexpr (std::is_same_v<T, double>) return H5T_NATIVE_DOUBLE;
  if constexpr (std::is_same_v<T, float>) return H5T_NATIVE_FLOAT;
  if constexpr (std::is_same_v<T, std::int32_t>) return H5T_NATIVE_INT32;
  if constexpr (std::is_same_v<T, std::int64_t>) return H5T_NATIVE_INT64;
  if constexpr (std::is_same_v<T, std::uint64_t>) return H5T_NATIVE_UINT64;
  if constexpr (std::is_same_v<T, std::uint8_t>) return H5T_NATIVE_UINT8;
}

/// The size of an array: rows, and numbers in a row. One number in a row makes the array one-dimensional.
struct Shape {
  hsize_t rows = 0;
  hsize_t components = 1;
};

enum class Filter { none, compressed };  ///< compressed: shuffle and gzip

/// Arrays of fixed size, and arrays that can grow, of numbers of any type(). Rows come one after the other.
/// @{
void write_array(hid_t parent, const std::string& name, hid_t type, const void* values, Shape shape, Filter filter);
template <class T>
void write_array(hid_t parent, const std::string& name, std::span<const T> values, Filter filter = Filter::none,
                 std::size_t components = 1) {
  write_array(parent, name, type<T>(), values.data(), {values.size() / components, components}, filter);
}

/// Creates an empty array that can grow. @param rows_per_chunk  >= 1
void create_rows(hid_t parent, const std::string& name, hid_t type, std::size_t components, std::size_t rows_per_chunk,
                 Filter filter = Filter::none);

void append_rows(hid_t parent, const std::string& name, hid_t type, const void* values, std::size_t numbers);
template <class T>
void append_rows(hid_t parent, const std::string& name, std::span<const T> values) {
  append_rows(parent, name, type<T>(), values.data(), values.size());
}

/// Rows first .. first + count - 1. @throws IoError where the array has fewer
/// @{
std::size_t numbers_in_rows(hid_t parent, const std::string& name, std::size_t first, std::size_t count);
void read_rows(hid_t parent, const std::string& name, hid_t type, std::size_t first, std::size_t count, void* values);
template <class T>
std::vector<T> read_rows(hid_t parent, const std::string& name, std::size_t first, std::size_t count) {
  std::vector<T> values(numbers_in_rows(parent, name, first, count));
  read_rows(parent, name, type<T>(), first, count, values.data());
  return values;
}
/// @}
std::size_t count_rows(hid_t parent, const std::string& name);
template <class T>
std::vector<T> read_array(hid_t parent, const std::string& name) {
  return read_rows<T>(parent, name, 0, count_rows(parent, name));
}

/// Cuts the array to its first `rows` rows. @throws IoError where it has fewer
void truncate_rows(hid_t parent, const std::string& name, std::size_t rows);
/// @}

/// Attributes: a scalar, a list, or a fixed-length string in UTF-8. Writing over an attribute of the same type replaces
/// its value.
/// @{
void write_attribute(hid_t object, const std::string& name, hid_t type, hid_t space, const void* values);
void read_attribute(hid_t object, const std::string& name, hid_t type, void* value);
template <class T>
void write_attribute(hid_t object, const std::string& name, T value) {
  write_attribute(object, name, type<T>(), Id(H5Screate(H5S_SCALAR), "cannot create an attribute"), &value);
}
template <class T>
T read_attribute(hid_t object, const std::string& name) {
  T value{};
  read_attribute(object, name, type<T>(), &value);
  return value;
}
template <class T>
void write_attribute_list(hid_t object, const std::string& name, std::span<const T> values) {
  const hsize_t count = values.size();
  const Id space(H5Screate_simple(1, &count, nullptr), "cannot create an attribute");
  write_attribute(object, name, type<T>(), space, values.data());
}
void write_text_attribute(hid_t object, const std::string& name, const std::string& text);
std::string read_text_attribute(hid_t object, const std::string& name);
bool has_attribute(hid_t object, const std::string& name);
/// @}

}  // namespace talus::hdf5
