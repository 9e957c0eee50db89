#include <algorithm>
#include <array>
#include <cstdint>

#include "io/hdf5.hpp"
#include "io/hdf5_detail.hpp"
#include "support/error.hpp"

namespace talus::hdf5 {
namespace {

constexpr hsize_t max_size = hsize_t{1} << 40;  ///< numbers; an array that claims more is not believed
constexpr hsize_t max_read = hsize_t{1} << 30;  ///< numbers read at once

Id open_dataset(hid_t parent, const std::string& name) {
  const std::string what = doing("find", parent, name);
  return Id(H5Dopen2(parent, name.c_str(), H5P_DEFAULT), H5Dclose, what);
}

/// Rows and numbers in a row.
struct Shape {
  hsize_t rows = 0;
  hsize_t components = 1;
};

Shape shape_of(hid_t dataset, hid_t parent, const std::string& name) {
  const std::string what = doing("read", parent, name);
  const Id space(H5Dget_space(dataset), H5Sclose, what);
  std::array<hsize_t, 2> dims{0, 1};
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 1 || rank > 2) throw IoError(what + ": it is neither a list nor a table");
  H5Sget_simple_extent_dims(space, dims.data(), nullptr);
  if (dims[1] == 0 || dims[0] > max_size / dims[1]) throw IoError(what + ": its size is out of all reason");
  return {dims[0], dims[1]};
}

template <class T>
std::vector<T> room_for(hsize_t numbers, const std::string& what) {
  if (numbers > max_read) throw IoError(what + ": its size is out of all reason");
  return std::vector<T>(numbers);
}

Id make_dataset(hid_t parent, const std::string& name, hid_t type, Shape shape, Shape chunk, bool growing,
                Filter filter) {
  const int rank = shape.components == 1 ? 1 : 2;
  const std::array<hsize_t, 2> dims{shape.rows, shape.components};
  const std::array<hsize_t, 2> most{growing ? H5S_UNLIMITED : shape.rows, shape.components};
  const std::array<hsize_t, 2> chunk_dims{std::max<hsize_t>(chunk.rows, 1), chunk.components};
  const std::string what = doing("create", parent, name);
  const Id space(H5Screate_simple(rank, dims.data(), most.data()), H5Sclose, what);
  const Id list(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, what);
  herr_t status = H5Pset_obj_track_times(list, false);
  const bool compressed = filter == Filter::compressed && (growing || shape.rows > 0);
  if (growing || compressed) status |= H5Pset_chunk(list, rank, chunk_dims.data());
  if (compressed) status |= H5Pset_shuffle(list) | H5Pset_deflate(list, 1);
  if (status < 0) fail(what);
  return Id(H5Dcreate2(parent, name.c_str(), type, space, H5P_DEFAULT, list, H5P_DEFAULT), H5Dclose, what);
}

/// The file's part that holds rows first .. first + count - 1.
Id select_rows(hid_t dataset, hsize_t first, hsize_t count, hsize_t components, const std::string& what) {
  Id space(H5Dget_space(dataset), H5Sclose, what);
  const std::array<hsize_t, 2> start{first, 0};
  const std::array<hsize_t, 2> size{count, components};
  if (H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, size.data(), nullptr) < 0) fail(what);
  return space;
}

}  // namespace

template <class T>
void write_array(hid_t parent, const std::string& name, std::span<const T> values, Filter filter,
                 std::size_t components) {
  constexpr hsize_t rows_per_chunk = 65536;
  const Shape shape{values.size() / components, components};
  const Id dataset = make_dataset(parent, name, stored_type<T>(), shape,
                                  {std::min(shape.rows, rows_per_chunk), components}, false, filter);
  check(H5Dwrite(dataset, native_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), "write", parent, name);
}

template <class T>
std::vector<T> read_array(hid_t parent, const std::string& name) {
  const Id dataset = open_dataset(parent, name);
  const Shape shape = shape_of(dataset, parent, name);
  std::vector<T> values = room_for<T>(shape.rows * shape.components, doing("read", parent, name));
  check(H5Dread(dataset, native_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), "read", parent, name);
  return values;
}

template <class T>
void create_rows(hid_t parent, const std::string& name, std::size_t components, std::size_t rows_per_chunk,
                 Filter filter) {
  make_dataset(parent, name, stored_type<T>(), {0, components}, {rows_per_chunk, components}, true, filter);
}

template <class T>
void append_rows(hid_t parent, const std::string& name, std::span<const T> values) {
  if (values.empty()) return;
  const std::string what = doing("write", parent, name);
  const Id dataset = open_dataset(parent, name);
  const Shape old = shape_of(dataset, parent, name);
  const hsize_t count = values.size() / old.components;
  const std::array<hsize_t, 2> dims{old.rows + count, old.components};
  if (H5Dset_extent(dataset, dims.data()) < 0) fail(what);
  const Id in_file = select_rows(dataset, old.rows, count, old.components, what);
  const Id here = list_space(values.size(), what);
  if (H5Dwrite(dataset, native_type<T>(), here, in_file, H5P_DEFAULT, values.data()) < 0) fail(what);
}

template <class T>
std::vector<T> read_rows(hid_t parent, const std::string& name, std::size_t first, std::size_t count) {
  const std::string what = doing("read", parent, name);
  const Id dataset = open_dataset(parent, name);
  const Shape shape = shape_of(dataset, parent, name);
  if (first > shape.rows || count > shape.rows - first)
    throw IoError(what + ": it has " + std::to_string(shape.rows) + " rows, " + std::to_string(first + count) +
                  " are wanted");
  std::vector<T> values = room_for<T>(count * shape.components, what);
  if (values.empty()) return values;
  const Id in_file = select_rows(dataset, first, count, shape.components, what);
  const Id here = list_space(values.size(), what);
  if (H5Dread(dataset, native_type<T>(), here, in_file, H5P_DEFAULT, values.data()) < 0) fail(what);
  return values;
}

void truncate_rows(hid_t parent, const std::string& name, std::size_t rows) {
  const Id dataset = open_dataset(parent, name);
  const Shape shape = shape_of(dataset, parent, name);
  if (rows > shape.rows)
    throw IoError(doing("truncate", parent, name) + ": it has only " + std::to_string(shape.rows) + " rows");
  const std::array<hsize_t, 2> dims{rows, shape.components};
  check(H5Dset_extent(dataset, dims.data()), "truncate", parent, name);
}

#define TALUS_HDF5(T)                                                                               \
  template void write_array<T>(hid_t, const std::string&, std::span<const T>, Filter, std::size_t); \
  template std::vector<T> read_array<T>(hid_t, const std::string&);                                 \
  template void create_rows<T>(hid_t, const std::string&, std::size_t, std::size_t, Filter);        \
  template void append_rows<T>(hid_t, const std::string&, std::span<const T>);                      \
  template std::vector<T> read_rows<T>(hid_t, const std::string&, std::size_t, std::size_t);
TALUS_HDF5(double)
TALUS_HDF5(float)
TALUS_HDF5(std::int32_t)
TALUS_HDF5(std::int64_t)
TALUS_HDF5(std::uint64_t)
TALUS_HDF5(std::uint8_t)
#undef TALUS_HDF5

}  // namespace talus::hdf5
