#pragma once
// JSON -> Case: the only place of unit conversion and range checks.

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "case/case.hpp"
#include "support/error.hpp"

namespace talus {

/// A case and where it came from.
struct LoadedCase {
  Case value;
  nlohmann::ordered_json
      resolved;      ///< the whole case with every default spelt out and files inlined; itself a valid case file
  std::string hash;  ///< 16 hex digits over what decides the runs of `resolved`, see case_hash
  std::filesystem::path path;        ///< the file read; empty when the document was given
  std::vector<Fault> warnings = {};  ///< what can be run but may not be meant
};

/// Reads a case file, applies `--set key.path=value` overrides, checks everything and converts it.
/// @throws ConfigError with every fault found, each with its JSON pointer
/// @throws IoError when the file cannot be read
LoadedCase load_case(const std::filesystem::path& path, std::span<const std::string> overrides = {});

/// The same for a document already parsed; files beside the case are looked up in `directory`.
LoadedCase load_case(const nlohmann::ordered_json& document, const std::filesystem::path& directory,
                     std::span<const std::string> overrides = {});

/// FNV-1a (64 bits, 16 hex digits) over the resolved case with its keys sorted, less what decides no run: title,
/// description and those keys of the study that only count or summarise runs. The seed is left out too: it stands
/// beside the hash in every record, and may be given on the command line.
std::string case_hash(const nlohmann::ordered_json& resolved);

}  // namespace talus
