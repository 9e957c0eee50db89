#pragma once
// What `talus field` writes: the random properties of a case on its particles before they move.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "case/load.hpp"
#include "run/realization.hpp"

namespace talus::cli {

/// A column of a table: "cohesion_kPa".
struct Column {
  std::string name;
  std::vector<double> values;
};

struct FieldOnParticles {
  std::vector<Vec2> position;  ///< [m]
  Strength strength;
  std::vector<Column> columns;          ///< friction_angle_deg, then the other random properties
  std::vector<Column> spreads;          ///< median_... and stdev_... of the random properties, where they are asked for
  Property shown = Property::friction;  ///< that of pictures
  std::optional<FieldSpread> spread;    ///< of it
};

/// The property of a key of property_names, which is known.
Property property_of(std::string_view key);

/// The first property that realizations differ in; friction where none does.
Property first_random(const Case& problem);

/// @param shown   the property of pictures
/// @param spread  also median and standard deviation over realizations
/// @throws ConfigError when `shown` is not random in the case, or the field cannot be built
FieldOnParticles field_on(const Case& problem, const RunIdentity& identity, Property shown, bool spread);

/// Values in SI units in the unit of property_names; an angle for friction, whose values are tangents.
std::vector<double> displayed(std::vector<double> values, Property property);

}  // namespace talus::cli
