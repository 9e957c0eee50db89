#include <array>
#include <atomic>

#include "io/hdf5.hpp"
#include "io/hdf5_detail.hpp"
#include "support/error.hpp"

namespace talus::hdf5 {
namespace {

/// The error stack's innermost description.
herr_t take_first(unsigned, const H5E_error2_t* error, void* text) {
  auto& reason = *static_cast<std::string*>(text);
  if (reason.empty() && error->desc != nullptr) reason = error->desc;
  return 0;
}

/// ": <HDF5's own reason>" of the last call that failed, for as long as no other call is made.
std::string reason() {
  std::string text;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_first, &text);
  return text.empty() ? text : ": " + text;
}

Id access_list() {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  Id list(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "cannot prepare a file");
  // The oldest format: one that is not marked as open while it is written to, so that a killed process leaves a
  // readable file.
  H5Pset_libver_bounds(list, H5F_LIBVER_EARLIEST, H5F_LIBVER_V110);
  H5Pset_file_locking(list, false, true);
  H5Pset_fclose_degree(list, H5F_CLOSE_STRONG);
  return list;
}

Id in_memory_access_list() {
  Id list = access_list();
  constexpr std::size_t growth = 1 << 20;
  if (H5Pset_fapl_core(list, growth, false) < 0) fail("cannot prepare a file in memory");
  return list;
}

/// HDF5 takes two files of one name for the same file, even in memory.
std::string unique_name(const std::string& name) {
  static std::atomic<unsigned> counter{0};
  return name + "/image" + std::to_string(counter++);
}

}  // namespace

void fail(const std::string& what) { throw IoError(what + reason()); }

std::string doing(std::string_view verb, hid_t parent, const std::string& name) {
  std::array<char, 1024> file{};
  std::array<char, 1024> group{};
  H5Fget_name(parent, file.data(), file.size());
  H5Iget_name(parent, group.data(), group.size());
  const std::string place = std::string_view(group.data()) == "/" ? "" : group.data();
  const std::string object = name.empty() ? place : place + "/" + name;
  return "cannot " + std::string(verb) + " " + (object.empty() ? "" : object + " in ") + file.data();
}

void check(herr_t status, std::string_view verb, hid_t parent, const std::string& name) {
  if (status >= 0) return;
  const std::string why = reason();
  throw IoError(doing(verb, parent, name) + why);
}

Id list_space(hsize_t count, const std::string& what) {
  return Id(H5Screate_simple(1, &count, nullptr), H5Sclose, what);
}

Id create_in_memory() {
  const Id list = in_memory_access_list();
  const Id creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose, "cannot prepare a file in memory");
  H5Pset_obj_track_times(creation, false);
  return Id(H5Fcreate(unique_name("memory").c_str(), H5F_ACC_TRUNC, creation, list), H5Fclose,
            "cannot create a file in memory");
}

Id open_image(std::string_view image, const std::string& name) {
  const Id list = in_memory_access_list();
  // HDF5 takes its own copy of the buffer, which it does not change.
  if (H5Pset_file_image(list, const_cast<char*>(image.data()), image.size()) < 0) fail("cannot read " + name);
  return Id(H5Fopen(unique_name(name).c_str(), H5F_ACC_RDONLY, list), H5Fclose, "cannot read " + name);
}

Id open_file(const std::filesystem::path& path, Access access) {
  const Id list = access_list();
  const bool read = access == Access::read;
  return Id(H5Fopen(path.c_str(), read ? H5F_ACC_RDONLY : H5F_ACC_RDWR, list), H5Fclose,
            std::string("cannot ") + (read ? "read " : "write ") + path.string());
}

std::string image(const Id& file) {
  flush(file);
  const ssize_t size = H5Fget_file_image(file, nullptr, 0);
  if (size < 0) fail("cannot make a file in memory");
  std::string bytes(static_cast<std::size_t>(size), '\0');
  if (H5Fget_file_image(file, bytes.data(), bytes.size()) < 0) fail("cannot make a file in memory");
  return bytes;
}

void flush(const Id& file) { check(H5Fflush(file, H5F_SCOPE_GLOBAL), "write", file, ""); }

Id create_group(hid_t parent, const std::string& name) {
  const std::string what = doing("create", parent, name);
  const Id list(H5Pcreate(H5P_GROUP_CREATE), H5Pclose, what);
  H5Pset_obj_track_times(list, false);
  return Id(H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, list, H5P_DEFAULT), H5Gclose, what);
}

Id open_group(hid_t parent, const std::string& name) {
  const std::string what = doing("find", parent, name);
  return Id(H5Gopen2(parent, name.c_str(), H5P_DEFAULT), H5Gclose, what);
}

bool has(hid_t parent, const std::string& name) { return H5Lexists(parent, name.c_str(), H5P_DEFAULT) > 0; }

std::vector<std::string> names(hid_t group) {
  H5G_info_t info{};
  check(H5Gget_info(group, &info), "list", group, "");
  std::vector<std::string> all;
  for (hsize_t i = 0; i < info.nlinks; ++i) {
    std::array<char, 1024> name{};
    const ssize_t length =
        H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, i, name.data(), name.size(), H5P_DEFAULT);
    check(length < static_cast<ssize_t>(name.size()) ? static_cast<herr_t>(length) : -1, "list", group, "");
    all.emplace_back(name.data());
  }
  return all;
}

}  // namespace talus::hdf5
