#pragma once
// `--set key.path=value`: edits a document before it is checked, so that the same check holds for both.

#include <span>
#include <string>
#include <vector>

#include "support/faults.hpp"
#include "support/json.hpp"

namespace talus {

/// What a `--set` changed and how it was written.
struct Override {
  std::string pointer;  ///< "/random_field/terms"
  std::string text;     ///< "random_field.terms=50"
};

/// Applies overrides in order. The path's parts are keys or indices of existing array elements; missing objects on the
/// way are made. The value is JSON, or else a plain string; `null` removes the key (as in RFC 7396).
std::vector<Override> apply_overrides(Json& document, std::span<const std::string> overrides, Faults& faults);

/// The faults with " (from --set ...)" added where an override concerns the place.
std::vector<Fault> name_origins(std::vector<Fault> faults, std::span<const Override> overrides);

}  // namespace talus
