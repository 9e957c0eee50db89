#pragma once
// The JSON Schema of a case, and the list of its keys; both follow from the declarations that the reader makes.

#include <string>
#include <string_view>
#include <vector>

#include "support/json.hpp"

namespace talus {

/// JSON Schema (draft 7) of a case file: schemas/case.schema.json.
Json case_schema();

/// A key that `--set` takes.
struct CaseKey {
  std::string path;         ///< "numerics.cfl"; an element of a list is 0, as in "slide.outlines.0.material.name"
  std::string description;  ///< meaning, unit, range, default, source
  std::vector<std::string> choices;  ///< the words it takes; empty: not a choice
};

/// Every key that holds a value, in the order of the schema.
std::vector<CaseKey> case_keys();

/// The path of the first key of this name that stands in a section, "" when there is none: "material.cohesion_Pa".
std::string path_of_key(std::string_view name);

}  // namespace talus
