#include "io/checkpoint.hpp"

#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <stdexcept>

#include "io/hdf5.hpp"
#include "support/digest.hpp"
#include "support/error.hpp"
#include "support/files.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t format = 3;          // 2: with the sums of the energy balance; 3: and of the thickness
constexpr std::size_t preamble_size = 512;  ///< HDF5 looks for its own beginning at 0, 512, 1024 ... bytes
constexpr std::string_view magic = "talus checkpoint";

/// What stands before the HDF5 part.
std::string preamble(std::string_view body) {
  char text[preamble_size];
  const int length = std::snprintf(text, sizeof text, "%s\nbytes %zu\nfnv1a64 %016" PRIx64 "\n", magic.data(),
                                   body.size(), fnv1a64(body));
  std::string block(text, static_cast<std::size_t>(length));
  block.resize(preamble_size, '\0');
  return block;
}

/// The HDF5 part of a file. @throws IoError when it is not as it was written
std::string_view checked_body(std::string_view content, const fs::path& path) {
  if (!content.starts_with(magic)) throw IoError(path.string() + " is not a checkpoint of Talus");
  const std::string_view body = content.substr(std::min(preamble_size, content.size()));
  if (content.substr(0, preamble_size) != preamble(body))
    throw IoError(
        path.string() +
        " is truncated or damaged (its length or checksum is not the recorded one); start the run again without it");
  return body;
}

template <class T>
void write_arrays(hid_t file, const std::string& group_name, const std::map<std::string, std::vector<T>>& arrays) {
  const hdf5::Id group = hdf5::create_group(file, group_name);
  for (const auto& [name, values] : arrays) {
    if (name.empty() || name == "." || name.find('/') != std::string::npos)
      throw std::invalid_argument("checkpoint: array name \"" + name + "\"");
    hdf5::write_array<T>(group, name, values);
  }
}

template <class T>
std::map<std::string, std::vector<T>> read_arrays(hid_t file, const std::string& group_name) {
  const hdf5::Id group = hdf5::open_group(file, group_name);
  std::map<std::string, std::vector<T>> arrays;
  for (const std::string& name : hdf5::names(group)) arrays[name] = hdf5::read_array<T>(group, name);
  return arrays;
}

void write(hid_t file, const char* name, const std::string& text) { hdf5::write_text_attribute(file, name, text); }
void write(hid_t file, const char* name, std::uint64_t value) { hdf5::write_attribute(file, name, value); }
template <class T>
void write(hid_t file, const char* name, const std::optional<T>& value) {
  if (value) hdf5::write_attribute(file, name, *value);
}

void read(hid_t file, const char* name, std::string& text) { text = hdf5::read_text_attribute(file, name); }
void read(hid_t file, const char* name, std::uint64_t& value) {
  value = hdf5::read_attribute<std::uint64_t>(file, name);
}
template <class T>
void read(hid_t file, const char* name, std::optional<T>& value) {
  if (hdf5::has_attribute(file, name)) value = hdf5::read_attribute<T>(file, name);
}

std::string text(const std::string& value) { return value; }
std::string text(std::uint64_t value) { return std::to_string(value); }
std::string text(const std::optional<std::int64_t>& value) { return value ? std::to_string(*value) : "none"; }
std::string text(const std::optional<double>& value) { return value ? to_text(*value) : "none"; }

/// Calls use(name of the attribute, word in messages, member) for each member of a header.
template <class Header, class Use>
void for_each_member(Header& header, Use use) {
  use("talus_version", "version", header.talus_version);
  use("case_hash", "case", header.case_hash);
  use("seed", "seed", header.seed);
  use("realization", "realization", header.realization);
  use("perturbation", "perturbation", header.perturbation);
}

/// "; seed 7, wanted 8" for each member that differs.
std::string differences(const CheckpointHeader& found, const CheckpointHeader& expected) {
  std::vector<std::string> wanted;
  for_each_member(expected, [&](auto, auto, const auto& value) { wanted.push_back(text(value)); });
  std::string all;
  auto next = wanted.begin();
  for_each_member(found, [&](auto, const std::string& word, const auto& value) {
    const std::string& other = *next++;
    if (text(value) != other) all += "; " + word + " " + text(value) + ", wanted " + other;
  });
  return all;
}

}  // namespace

void write_checkpoint(const fs::path& path, const CheckpointState& state, const CheckpointHeader& header) {
  const hdf5::Id file = hdf5::create_in_memory();
  hdf5::write_attribute(file, "format", format);
  for_each_member(header, [&](const char* name, auto, const auto& value) { write(file, name, value); });
  hdf5::write_attribute(file, "wall_clock_s", state.wall_clock);
  write_arrays(file, "reals", state.reals);
  write_arrays(file, "integers", state.integers);
  std::string content = hdf5::image(file);
  content.insert(0, preamble(content));
  write_file_atomically(path, content);
}

CheckpointState read_checkpoint(const fs::path& path, const CheckpointHeader& expected) {
  const std::string content = read_file(path, std::numeric_limits<std::size_t>::max());
  const hdf5::Id file = hdf5::open_image(checked_body(content, path), path.string());
  const auto found_format = hdf5::read_attribute<std::int64_t>(file, "format");
  if (found_format != format)
    throw IoError(path.string() + " has checkpoint format " + std::to_string(found_format) +
                  "; this program reads format " + std::to_string(format));
  CheckpointHeader found;
  for_each_member(found, [&](const char* name, auto, auto& value) { read(file, name, value); });
  if (const std::string differ = differences(found, expected); !differ.empty())
    throw IoError(path.string() + " is the checkpoint of another run" + differ);
  std::optional<double> wall_clock;
  read(file, "wall_clock_s", wall_clock);
  return {.reals = read_arrays<double>(file, "reals"),
          .integers = read_arrays<std::int64_t>(file, "integers"),
          .wall_clock = wall_clock.value_or(0.0)};
}

}  // namespace talus
