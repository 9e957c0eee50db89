#include "io/hdf5.hpp"

#include <algorithm>
#include <array>
#include <atomic>

#include "support/error.hpp"

namespace talus::hdf5 {
namespace {

constexpr hsize_t max_size = hsize_t{1} << 40;  ///< numbers; the file of an array that claims more is damaged
constexpr hsize_t max_read = hsize_t{1} << 30;  ///< numbers read at once
constexpr hsize_t max_chunk = 65'536;           ///< rows compressed together in an array of fixed size

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

/// What was being done to what, for a message: "cannot read /VTKHDF/Points in run/snapshots.vtkhdf".
std::string doing(std::string_view verb, hid_t parent, const std::string& name) {
  std::array<char, 1024> file{};
  std::array<char, 1024> group{};
  H5Fget_name(parent, file.data(), file.size());
  H5Iget_name(parent, group.data(), group.size());
  const std::string path = std::string_view(group.data()) == "/" ? "" : group.data();
  const std::string object = name.empty() ? path : path + "/" + name;
  return "cannot " + std::string(verb) + " " + (object.empty() ? "" : object + " in ") + file.data();
}

/// Throws the IoError of doing() when `status`, a code or an identifier, says that a call failed.
void check(hid_t status, std::string_view verb, hid_t parent, const std::string& name) {
  if (status >= 0) return;
  const std::string why = reason();
  throw IoError(doing(verb, parent, name) + why);
}

/// Owns an identifier that was made for `name`.
Id owned(hid_t id, std::string_view verb, hid_t parent, const std::string& name) {
  check(id, verb, parent, name);
  return Id(id, "");
}

/// A list of properties that leaves out the time stamps of what is created with it.
Id creation_list(hid_t list_class) {
  Id list(H5Pcreate(list_class), "cannot prepare an object");
  H5Pset_obj_track_times(list, false);
  return list;
}

Id access_list() {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  Id list(H5Pcreate(H5P_FILE_ACCESS), "cannot prepare a file");
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

Shape shape_of(hid_t array, hid_t parent, const std::string& name) {
  const Id space = owned(H5Dget_space(array), "read", parent, name);
  std::array<hsize_t, 2> dims{0, 1};
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 1 || rank > 2) throw IoError(doing("read", parent, name) + ": it is neither a list nor a table");
  H5Sget_simple_extent_dims(space, dims.data(), nullptr);
  if (dims[1] == 0 || dims[0] > max_size / dims[1])
    throw IoError(doing("read", parent, name) + ": its size is implausible");
  return {dims[0], dims[1]};
}

void resize(hid_t array, Shape shape, std::string_view verb, hid_t parent, const std::string& name) {
  const std::array<hsize_t, 2> dims{shape.rows, shape.components};
  check(H5Dset_extent(array, dims.data()), verb, parent, name);
}

/// `rows_per_chunk` 0: an array of fixed size.
Id create_array(hid_t parent, const std::string& name, hid_t type, Shape shape, hsize_t rows_per_chunk, Filter filter) {
  const bool growing = rows_per_chunk > 0;
  const bool compressed = filter == Filter::compressed && (growing || shape.rows > 0);
  const int rank = shape.components == 1 ? 1 : 2;
  const std::array<hsize_t, 2> dims{shape.rows, shape.components};
  const std::array<hsize_t, 2> most{growing ? H5S_UNLIMITED : shape.rows, shape.components};
  const std::array<hsize_t, 2> chunk{growing ? rows_per_chunk : std::min(shape.rows, max_chunk), shape.components};
  const Id space = owned(H5Screate_simple(rank, dims.data(), most.data()), "create", parent, name);
  const Id list = creation_list(H5P_DATASET_CREATE);
  if (growing || compressed) check(H5Pset_chunk(list, rank, chunk.data()), "create", parent, name);
  if (compressed) check(H5Pset_shuffle(list) | H5Pset_deflate(list, 1), "create", parent, name);
  return owned(H5Dcreate2(parent, name.c_str(), type, space, H5P_DEFAULT, list, H5P_DEFAULT), "create", parent, name);
}

/// The parts of the file and of the memory that hold rows first .. first + count - 1.
struct Selection {
  Id in_file, in_memory;
};
Selection select_rows(hid_t array, hsize_t first, hsize_t count, hsize_t components) {
  Selection rows{Id(H5Dget_space(array), "cannot select rows"), {}};
  const std::array<hsize_t, 2> start{first, 0};
  const std::array<hsize_t, 2> size{count, components};
  const hsize_t numbers = count * components;
  if (H5Sselect_hyperslab(rows.in_file, H5S_SELECT_SET, start.data(), nullptr, size.data(), nullptr) >= 0)
    rows.in_memory = Id(H5Screate_simple(1, &numbers, nullptr), "cannot select rows");
  return rows;
}

Id open_attribute(hid_t object, const std::string& name) {
  return owned(H5Aopen(object, name.c_str(), H5P_DEFAULT), "find", object, name);
}

/// Opens an attribute that must be a single value.
Id open_single(hid_t object, const std::string& name) {
  Id attribute = open_attribute(object, name);
  const Id space = owned(H5Aget_space(attribute), "read", object, name);
  if (H5Sget_simple_extent_npoints(space) != 1)
    throw IoError(doing("read", object, name) + ": it is not a single value");
  return attribute;
}

}  // namespace

void fail(const std::string& what) { throw IoError(what + reason()); }

Id create_in_memory() {
  const Id list = in_memory_access_list();
  const Id creation = creation_list(H5P_FILE_CREATE);
  return Id(H5Fcreate(unique_name("memory").c_str(), H5F_ACC_TRUNC, creation, list), "cannot create a file in memory");
}

Id open_image(std::string_view image, const std::string& name) {
  const Id list = in_memory_access_list();
  // HDF5 takes its own copy of the buffer, which it does not change.
  if (H5Pset_file_image(list, const_cast<char*>(image.data()), image.size()) < 0) fail("cannot read " + name);
  return Id(H5Fopen(unique_name(name).c_str(), H5F_ACC_RDONLY, list), "cannot read " + name);
}

Id open_file(const std::filesystem::path& path, Access access) {
  const Id list = access_list();
  const bool read = access == Access::read;
  return Id(H5Fopen(path.c_str(), read ? H5F_ACC_RDONLY : H5F_ACC_RDWR, list),
            std::string("cannot ") + (read ? "read " : "write ") + path.string());
}

std::string image(const Id& file) {
  flush(file);
  const ssize_t size = H5Fget_file_image(file, nullptr, 0);
  check(size, "write", file, "");
  std::string bytes(static_cast<std::size_t>(size), '\0');
  check(H5Fget_file_image(file, bytes.data(), bytes.size()), "write", file, "");
  return bytes;
}

hsize_t flush(const Id& file) {
  hsize_t size = 0;
  check(H5Fflush(file, H5F_SCOPE_GLOBAL), "write", file, "");
  check(H5Fget_filesize(file, &size), "write", file, "");
  return size;
}

Id create_group(hid_t parent, const std::string& name) {
  const Id list = creation_list(H5P_GROUP_CREATE);
  return owned(H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, list, H5P_DEFAULT), "create", parent, name);
}

Id open_group(hid_t parent, const std::string& name) {
  return owned(H5Gopen2(parent, name.c_str(), H5P_DEFAULT), "find", parent, name);
}

Id open_array(hid_t parent, const std::string& name) {
  return owned(H5Dopen2(parent, name.c_str(), H5P_DEFAULT), "find", parent, name);
}

bool has(hid_t parent, const std::string& name) { return H5Lexists(parent, name.c_str(), H5P_DEFAULT) > 0; }

std::vector<std::string> names(hid_t group) {
  std::vector<std::string> all;
  const auto add = [](hid_t, const char* name, const auto*, void* list) {
    static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return herr_t{0};
  };
  check(H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &all), "list", group, "");
  return all;
}

void write_array(hid_t parent, const std::string& name, hid_t type, const void* values, Shape shape, Filter filter) {
  const Id array = create_array(parent, name, type, shape, 0, filter);
  check(H5Dwrite(array, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), "write", parent, name);
}

void create_rows(hid_t parent, const std::string& name, hid_t type, std::size_t components, std::size_t rows_per_chunk,
                 Filter filter) {
  create_array(parent, name, type, {0, components}, rows_per_chunk, filter);
}

void append_rows(hid_t parent, const std::string& name, hid_t type, const void* values, std::size_t numbers) {
  if (numbers == 0) return;
  const Id array = open_array(parent, name);
  const auto [rows, components] = shape_of(array, parent, name);
  const hsize_t count = numbers / components;
  resize(array, {rows + count, components}, "write", parent, name);
  const Selection added = select_rows(array, rows, count, components);
  check(H5Dwrite(array, type, added.in_memory, added.in_file, H5P_DEFAULT, values), "write", parent, name);
}

std::size_t count_rows(hid_t parent, const std::string& name) {
  return shape_of(open_array(parent, name), parent, name).rows;
}

std::size_t numbers_in_rows(hid_t parent, const std::string& name, std::size_t first, std::size_t count) {
  const auto [rows, components] = shape_of(open_array(parent, name), parent, name);
  if (first > rows || count > rows - first)
    throw IoError(doing("read", parent, name) + ": it has " + std::to_string(rows) + " rows, " +
                  std::to_string(first + count) + " are needed");
  if (count * components > max_read) throw IoError(doing("read", parent, name) + ": its size is implausible");
  return count * components;
}

void read_rows(hid_t parent, const std::string& name, hid_t type, std::size_t first, std::size_t count, void* values) {
  if (count == 0) return;
  const Id array = open_array(parent, name);
  const Selection read = select_rows(array, first, count, shape_of(array, parent, name).components);
  check(H5Dread(array, type, read.in_memory, read.in_file, H5P_DEFAULT, values), "read", parent, name);
}

void truncate_rows(hid_t parent, const std::string& name, std::size_t rows) {
  const Id array = open_array(parent, name);
  const Shape shape = shape_of(array, parent, name);
  if (rows > shape.rows)
    throw IoError(doing("truncate", parent, name) + ": it has only " + std::to_string(shape.rows) + " rows");
  resize(array, {rows, shape.components}, "truncate", parent, name);
}

void write_attribute(hid_t object, const std::string& name, hid_t type, hid_t space, const void* values) {
  const Id attribute =
      has_attribute(object, name)
          ? open_attribute(object, name)
          : owned(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), "create", object, name);
  check(H5Awrite(attribute, type, values), "write", object, name);
}

void read_attribute(hid_t object, const std::string& name, hid_t type, void* value) {
  check(H5Aread(open_single(object, name), type, value), "read", object, name);
}

void write_text_attribute(hid_t object, const std::string& name, const std::string& text) {
  const Id type(H5Tcopy(H5T_C_S1), "cannot create an attribute");
  H5Tset_size(type, std::max<std::size_t>(text.size(), 1));
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  if (!std::ranges::all_of(text, [](unsigned char c) { return c < 128; })) H5Tset_cset(type, H5T_CSET_UTF8);
  write_attribute(object, name, type, Id(H5Screate(H5S_SCALAR), "cannot create an attribute"), text.c_str());
}

std::string read_text_attribute(hid_t object, const std::string& name) {
  const Id attribute = open_single(object, name);
  const Id type = owned(H5Aget_type(attribute), "read", object, name);
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0)
    throw IoError(doing("read", object, name) + ": it is not a text of fixed length");
  std::string text(H5Tget_size(type), '\0');
  check(H5Aread(attribute, type, text.data()), "read", object, name);
  text.resize(std::min(text.find('\0'), text.size()));
  return text;
}

bool has_attribute(hid_t object, const std::string& name) { return H5Aexists(object, name.c_str()) > 0; }

}  // namespace talus::hdf5
