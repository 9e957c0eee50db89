#pragma once
// JSON -> Case -> Plan: the only place of unit conversion and range checks.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "random_field/field_spec.hpp"
#include "simulation/model.hpp"
#include "study/plan.hpp"
#include "support/error.hpp"
#include "support/json.hpp"

namespace talus {

/// A case in SI units and radians: what a case file says once it is read and checked.
struct Case {
  std::string title;
  std::string description;
  Model model;
  std::optional<FieldSpec> field;  ///< unset: the friction angle is that of the material
  StudySpec study;
  bool operator==(const Case&) const = default;
};

/// A case and where it came from.
struct LoadedCase {
  Case value;
  Json resolved;     ///< the whole case with every default spelt out and files inlined; itself a valid case file
  std::string hash;  ///< 16 hex digits over what decides the runs of `resolved`, see case_hash
  std::string hash_without_end;      ///< the same less end and snapshot times: runs that differ in their length only
  std::filesystem::path path;        ///< the file read; empty when the document was given
  std::vector<std::string> files;    ///< CSV files and the form in which they were read
  std::string bed_source;            ///< where the bed was given, or that it was joined from surfaces
  std::vector<Fault> warnings = {};  ///< what can be run but may not be meant
};

/// Reads a case file, applies `--set key.path=value` overrides, checks everything and converts it.
/// @throws ConfigError with every fault found, each with its JSON pointer
/// @throws IoError when the file cannot be read
LoadedCase load_case(const std::filesystem::path& path, std::span<const std::string> overrides = {});

/// The same for a document already parsed; files beside the case are looked up in `directory`.
LoadedCase load_case(Json document, const std::filesystem::path& directory,
                     std::span<const std::string> overrides = {});

/// JSON pointer of the section that states a material of the model: /material of the default one, otherwise that of the
/// first outline of its kind.
std::string material_pointer(const Model& model, std::size_t material);

/// FNV-1a (64 bits, 16 hex digits) over the resolved case with its keys sorted, less what decides no run: title,
/// description and those keys of the study that only count or summarise runs. The seed is left out too: it stands
/// beside the hash in every record, and may be given on the command line.
std::string case_hash(const Json& resolved);

/// The plan of a study of `loaded` with a given seed.
/// @throws ConfigError when the study cannot be done: every realization would be the same, or a Latin hypercube asked
/// to stop early
Plan make_plan(const LoadedCase& loaded, std::uint64_t seed, const std::string& version);

}  // namespace talus
