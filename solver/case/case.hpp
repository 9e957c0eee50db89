#pragma once
// A case in SI units and radians: what a case file says once it is read and checked.

#include <optional>
#include <string>

#include "random_field/field_spec.hpp"
#include "simulation/model.hpp"
#include "study/plan.hpp"

namespace talus {

struct Case {
  std::string title;
  std::string description;
  Model model;
  std::optional<FieldSpec> field;  ///< unset: the friction angle is that of the material
  StudySpec study;
  bool operator==(const Case&) const = default;
};

}  // namespace talus
