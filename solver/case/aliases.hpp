#pragma once
// Former and British spellings of keys and words of a case. They keep working for one version, with a warning.

#include <string>
#include <string_view>
#include <vector>

#include "support/error.hpp"
#include "support/json.hpp"

namespace talus {

/// `section.key`, or `section.key=word` for one word of a choice. The schema has the present names only.
struct CaseAlias {
  std::string_view alias;
  std::string_view name;
};
inline constexpr CaseAlias case_aliases[] = {{"study.realisations", "study.realizations"},
                                             {"rheology.yield=regularised", "rheology.yield=regularized"}};

/// Puts the present names into a document and into `--set` texts. An alias beside its present name in one document is
/// left, and so reported as unknown.
/// @return a warning for each alias that was used
std::vector<Fault> replace_aliases(Json& document, std::vector<std::string>& overrides);

}  // namespace talus
