#pragma once
// Edits a document before it is checked, so that the same check holds for both: former spellings get their present
// names, and `--set key.path=value` is applied.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "support/faults.hpp"
#include "support/json.hpp"

namespace talus {

/// A former or British spelling of a key or of a word; it works for one version, with a warning. `section.key`, or
/// `section.key=word` for one word of a choice. The schema has the present names only.
struct CaseAlias {
  std::string_view alias;
  std::string_view name;
};
inline constexpr CaseAlias case_aliases[] = {{"study.realisations", "study.realizations"},
                                             {"rheology.yield=regularised", "rheology.yield=regularized"},
                                             {"terrain.left_boundary_m", "terrain.measured_from_m"}};

/// Puts the present names into a document and into `--set` texts. An alias beside its present name in one document is
/// left, and so reported as unknown.
/// @return a warning for each alias that was used
std::vector<Fault> replace_aliases(Json& document, std::vector<std::string>& overrides);

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
