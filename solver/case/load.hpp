#pragma once
// JSON -> Case: the only place of unit conversion and range checks.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include <nlohmann/json.hpp>

#include "case/case.hpp"

namespace talus {

/// A case and where it came from.
struct LoadedCase {
  Case value;
  nlohmann::ordered_json resolved;  ///< the whole case with every default spelt out and files inlined; itself a valid case file
  std::string hash;                 ///< 16 hex digits over what decides the runs of `resolved` (not title, description, study.realizations)
  std::filesystem::path path;       ///< the file read
};

/// Reads a case file, applies `--set key.path=value` overrides, checks everything and converts it.
/// @throws ConfigError with every fault found, each with its JSON pointer
/// @throws IoError when the file cannot be read
LoadedCase load_case(const std::filesystem::path& path, std::span<const std::string> overrides = {});

/// The same for a document already parsed; files beside the case are looked up in `directory`.
LoadedCase load_case(const nlohmann::ordered_json& document, const std::filesystem::path& directory, std::span<const std::string> overrides = {});

}  // namespace talus
