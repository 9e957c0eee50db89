#pragma once
// Which properties of the soil are random, and how each is distributed.

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace talus {

/// A property of the soil. The order is that of the coefficients xi, and the number keys the draws: new ones go to the
/// end.
enum class Property { friction, cohesion, unit_weight, viscosity };
inline constexpr std::size_t property_count = 4;

/// What files call a property, and the unit in which they give it.
struct PropertyName {
  std::string_view key;     ///< in a case and in results
  std::string_view unit;    ///< as in Quantity; "" for tan(phi)
  std::string_view suffix;  ///< of the keys that hold it
  double factor;            ///< from that unit to SI
};
/// A unit weight is divided by 9.81 m/s2, with which laboratories state it.
inline constexpr std::array<PropertyName, property_count> property_names{{{"friction", "", "tan_phi", 1.0},
                                                                          {"cohesion", "kPa", "kPa", 1e3},
                                                                          {"unit_weight", "kN/m3", "kN_m3", 1e3 / 9.81},
                                                                          {"viscosity", "Pa s", "Pa_s", 1.0}}};
constexpr std::size_t index_of(Property p) { return static_cast<std::size_t>(p); }
constexpr const PropertyName& name_of(Property p) { return property_names[index_of(p)]; }

/// A value of each property in SI units: tan(phi) [-], cohesion [Pa], density [kg/m3], viscosity [Pa s].
using PropertyValues = std::array<double, property_count>;

enum class MarginalKind { lognormal, normal, beta, uniform, constant };
enum class Varies { in_space, once };          ///< a field | one value a realization
enum class Layers { one_field, independent };  ///< one field or value through all materials | one for each of them

/// A random property as a case gives it, in the SI units of PropertyValues. Where neither `mean` nor `log_mean` is
/// given, the mean (with `log_stdev`: the median) is the value of each material.
struct PropertySpec {
  Property property = Property::friction;
  MarginalKind marginal = MarginalKind::lognormal;
  std::optional<double> mean = {};
  std::optional<double> cov = {};        ///< standard deviation / mean [-], >= 0
  std::optional<double> stdev = {};      ///< >= 0
  std::optional<double> log_mean = {};   ///< mean of the logarithm of the SI value
  std::optional<double> log_stdev = {};  ///< standard deviation of the logarithm [-], >= 0
  std::optional<double> low = {};        ///< bounds: of the truncated normal, beta and uniform distributions
  std::optional<double> high = {};
  Varies varies = Varies::in_space;
  Layers layers = Layers::one_field;
  std::string material = {};  ///< name of the materials that it applies to; empty: all

  bool random() const { return marginal != MarginalKind::constant; }
  bool in_space() const { return random() && varies == Varies::in_space; }
  bool applies_to(std::string_view name) const { return material.empty() || material == name; }
  bool operator==(const PropertySpec&) const = default;
};

/// The correlation coefficient of two properties at a point.
struct PropertyCorrelation {
  Property a = Property::friction, b = Property::cohesion;
  double value = 0.0;  ///< in (-1, 1)
  bool operator==(const PropertyCorrelation&) const = default;
};

}  // namespace talus
