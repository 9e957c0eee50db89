#include <algorithm>
#include <cstdint>

#include "io/hdf5.hpp"
#include "io/hdf5_detail.hpp"
#include "support/error.hpp"

namespace talus::hdf5 {
namespace {

Id open_attribute(hid_t object, const std::string& name) {
  const std::string what = doing("find", object, name);
  return Id(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, what);
}

Id make_attribute(hid_t object, const std::string& name, hid_t type, hid_t space) {
  if (has_attribute(object, name)) return open_attribute(object, name);
  const std::string what = doing("create", object, name);
  return Id(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, what);
}

void check_single(hid_t attribute, const std::string& what) {
  const Id space(H5Aget_space(attribute), H5Sclose, what);
  if (H5Sget_simple_extent_npoints(space) != 1) throw IoError(what + ": it is not a single value");
}

}  // namespace

template <class T>
void write_attribute(hid_t object, const std::string& name, T value) {
  const Id space(H5Screate(H5S_SCALAR), H5Sclose, "cannot create an attribute");
  const Id attribute = make_attribute(object, name, stored_type<T>(), space);
  check(H5Awrite(attribute, native_type<T>(), &value), "write", object, name);
}

template <class T>
T read_attribute(hid_t object, const std::string& name) {
  const Id attribute = open_attribute(object, name);
  check_single(attribute, doing("read", object, name));
  T value{};
  check(H5Aread(attribute, native_type<T>(), &value), "read", object, name);
  return value;
}

template <class T>
void write_attribute_array(hid_t object, const std::string& name, std::span<const T> values) {
  const Id space = list_space(values.size(), doing("create", object, name));
  const Id attribute = make_attribute(object, name, stored_type<T>(), space);
  check(H5Awrite(attribute, native_type<T>(), values.data()), "write", object, name);
}

void write_text_attribute(hid_t object, const std::string& name, const std::string& text) {
  const std::string what = doing("create", object, name);
  const Id type(H5Tcopy(H5T_C_S1), H5Tclose, what);
  H5Tset_size(type, std::max<std::size_t>(text.size(), 1));
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  const Id space(H5Screate(H5S_SCALAR), H5Sclose, what);
  const Id attribute = make_attribute(object, name, type, space);
  check(H5Awrite(attribute, type, text.c_str()), "write", object, name);
}

std::string read_text_attribute(hid_t object, const std::string& name) {
  const std::string what = doing("read", object, name);
  const Id attribute = open_attribute(object, name);
  check_single(attribute, what);
  const Id type(H5Aget_type(attribute), H5Tclose, what);
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0)
    throw IoError(what + ": it is not a text of fixed length");
  std::string text(H5Tget_size(type), '\0');
  if (H5Aread(attribute, type, text.data()) < 0) fail(what);
  text.resize(std::min(text.find('\0'), text.size()));
  return text;
}

bool has_attribute(hid_t object, const std::string& name) { return H5Aexists(object, name.c_str()) > 0; }

#define TALUS_HDF5(T)                                             \
  template void write_attribute<T>(hid_t, const std::string&, T); \
  template T read_attribute<T>(hid_t, const std::string&);        \
  template void write_attribute_array<T>(hid_t, const std::string&, std::span<const T>);
TALUS_HDF5(double)
TALUS_HDF5(float)
TALUS_HDF5(std::int32_t)
TALUS_HDF5(std::int64_t)
TALUS_HDF5(std::uint64_t)
TALUS_HDF5(std::uint8_t)
#undef TALUS_HDF5

}  // namespace talus::hdf5
