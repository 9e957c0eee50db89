#include "io/checkpoint.hpp"

#include <charconv>
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

constexpr std::int64_t format = 1;
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

void check_name(const std::string& name) {
  if (name.empty() || name == "." || name.find('/') != std::string::npos)
    throw std::invalid_argument("checkpoint: array name \"" + name + "\"");
}

template <class T>
void write_arrays(hid_t file, const std::string& group_name, const std::map<std::string, std::vector<T>>& arrays) {
  const hdf5::Id group = hdf5::create_group(file, group_name);
  for (const auto& [name, values] : arrays) {
    check_name(name);
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

void write_header(hid_t file, const CheckpointHeader& header) {
  hdf5::write_attribute(file, "format", format);
  hdf5::write_text_attribute(file, "talus_version", header.talus_version);
  hdf5::write_text_attribute(file, "case_hash", header.case_hash);
  hdf5::write_attribute(file, "seed", header.seed);
  if (header.realization) hdf5::write_attribute(file, "realization", *header.realization);
  if (header.perturbation) hdf5::write_attribute(file, "perturbation", *header.perturbation);
}

template <class T>
std::optional<T> read_optional(hid_t file, const std::string& name) {
  if (!hdf5::has_attribute(file, name)) return std::nullopt;
  return hdf5::read_attribute<T>(file, name);
}

CheckpointHeader read_header(hid_t file) {
  return {.talus_version = hdf5::read_text_attribute(file, "talus_version"),
          .case_hash = hdf5::read_text_attribute(file, "case_hash"),
          .seed = hdf5::read_attribute<std::uint64_t>(file, "seed"),
          .realization = read_optional<std::int64_t>(file, "realization"),
          .perturbation = read_optional<double>(file, "perturbation")};
}

std::string text(const std::string& value) { return value; }
std::string text(std::uint64_t value) { return std::to_string(value); }
std::string text(const std::optional<std::int64_t>& value) { return value ? std::to_string(*value) : "none"; }
std::string text(const std::optional<double>& value) { return value ? to_text(*value) : "none"; }

/// "; seed 7, wanted 8" for each part that differs.
std::string differences(const CheckpointHeader& found, const CheckpointHeader& expected) {
  std::string all;
  const auto compare = [&all](const char* what, const auto& a, const auto& b) {
    if (a != b) all += std::string("; ") + what + " " + text(a) + ", wanted " + text(b);
  };
  compare("version", found.talus_version, expected.talus_version);
  compare("case", found.case_hash, expected.case_hash);
  compare("seed", found.seed, expected.seed);
  compare("realization", found.realization, expected.realization);
  compare("perturbation", found.perturbation, expected.perturbation);
  return all;
}

}  // namespace

void write_checkpoint(const fs::path& path, const CheckpointState& state, const CheckpointHeader& header) {
  const hdf5::Id file = hdf5::create_in_memory();
  write_header(file, header);
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
  if (const std::string differ = differences(read_header(file), expected); !differ.empty())
    throw IoError(path.string() + " is the checkpoint of another run" + differ);
  return {.reals = read_arrays<double>(file, "reals"),
          .integers = read_arrays<std::int64_t>(file, "integers"),
          .wall_clock = read_optional<double>(file, "wall_clock_s").value_or(0.0)};
}

}  // namespace talus
