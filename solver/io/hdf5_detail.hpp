#pragma once
// What the parts of the HDF5 wrapper share.

#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

#include "io/hdf5.hpp"

namespace talus::hdf5 {

/// T in memory.
template <class T>
hid_t native_type() {
  if constexpr (std::is_same_v<T, double>) return H5T_NATIVE_DOUBLE;
  if constexpr (std::is_same_v<T, float>) return H5T_NATIVE_FLOAT;
  if constexpr (std::is_same_v<T, std::int32_t>) return H5T_NATIVE_INT32;
  if constexpr (std::is_same_v<T, std::int64_t>) return H5T_NATIVE_INT64;
  if constexpr (std::is_same_v<T, std::uint64_t>) return H5T_NATIVE_UINT64;
  if constexpr (std::is_same_v<T, std::uint8_t>) return H5T_NATIVE_UINT8;
}

/// T in the file.
template <class T>
hid_t stored_type() {
  if constexpr (std::is_same_v<T, double>) return H5T_IEEE_F64LE;
  if constexpr (std::is_same_v<T, float>) return H5T_IEEE_F32LE;
  if constexpr (std::is_same_v<T, std::int32_t>) return H5T_STD_I32LE;
  if constexpr (std::is_same_v<T, std::int64_t>) return H5T_STD_I64LE;
  if constexpr (std::is_same_v<T, std::uint64_t>) return H5T_STD_U64LE;
  if constexpr (std::is_same_v<T, std::uint8_t>) return H5T_STD_U8LE;
}

/// What was being done to what, for a message: "cannot read /VTKHDF/Points in run/snapshots.vtkhdf".
std::string doing(std::string_view verb, hid_t parent, const std::string& name);

/// Throws the IoError of doing() when `status` says so.
void check(herr_t status, std::string_view verb, hid_t parent, const std::string& name);

/// A list of `count` numbers in memory.
Id list_space(hsize_t count, const std::string& what);

}  // namespace talus::hdf5
