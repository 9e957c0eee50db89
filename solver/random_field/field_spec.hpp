#pragma once
// What random field of the soil a study asks for.

#include <algorithm>
#include <optional>
#include <vector>

#include "math/vec2.hpp"
#include "random_field/covariance.hpp"
#include "random_field/property_spec.hpp"

namespace talus {

enum class FieldDirection { xy, x, y };  ///< two-dimensional, or varying along one axis only
enum class Truncation { largest, diagonal, variance_share };
enum class RootIntervals { complete, paper };  ///< each mode once | [Z20] Eqs. 15, 21 as printed: modes 1 4 5 8 9 ...
enum class FieldSampler { karhunen_loeve, circulant_embedding };

/// A measured property.
struct FieldDatum {
  Vec2 x;                                  ///< where [m]
  double value;                            ///< friction angle [rad], in (0, pi/2); else as in PropertyValues
  double error;                            ///< its standard error in the same unit, >= 0; 0: exact
  Property property = Property::friction;  ///< friction without FieldSpec::properties
  bool operator==(const FieldDatum&) const = default;
};

/// Without `properties`: ln(tan phi) = mu + sigma Z(x), Z a standard Gaussian field; with the default covariance,
/// exp(-|dx|/ell_x - |dy|/ell_y), that of [Z20] Eqs. 11-23. With a dip, x and y in what follows are the axes along and
/// across the bedding.
struct FieldSpec {
  FieldDirection direction = FieldDirection::xy;
  double ell_x = 1.0;               ///< correlation length along x [m], > 0; what it means: covariance.hpp
  double ell_y = 1.0;               ///< correlation length along y [m], > 0
  std::optional<double> mu = {};    ///< mean of ln(tan phi) [-]; unset: ln(tan phi) of each particle's material
  std::optional<double> mean = {};  ///< mean of tan(phi) [-], > 0, in place of mu: mu follows from it at each point
  double sigma = 0.0;               ///< standard deviation of ln(tan phi) [-]; a negative one changes the sign of Z
  FieldSampler sampler = FieldSampler::karhunen_loeve;
  Truncation truncation = Truncation::largest;
  int terms = 5;                 ///< M of [Z20] Eq. 11, >= 1; for `largest` and `diagonal`
  double variance_share = 0.95;  ///< for `variance_share`, in (0, 1)
  RootIntervals root_intervals = RootIntervals::complete;
  bool cell_average = false;                ///< average the field over each particle's cell dx by dx
  std::optional<Box> domain = {};           ///< where the modes are solved [m]; unset: the bounding box of the slide
  std::vector<double> xi = {};              ///< given standard normal coefficients instead of drawn ones; empty: drawn
  std::optional<double> grid_spacing = {};  ///< of the circulant embedding [m]; unset: a tenth of ell along each axis
  Covariance covariance = Covariance::exponential;
  double dip = 0.0;                   ///< angle by which the bedding falls towards +x [rad], -pi/2 to pi/2
  double nugget = 0.0;                ///< share of the variance that is white noise of the particles [-], in [0, 1)
  std::vector<FieldDatum> data = {};  ///< measured values that every realization meets within their errors
  double trend = 0.0;  ///< increase of the friction angle of the median with the depth below the surface [rad/m]
  std::vector<PropertySpec> properties = {};  ///< in the order of Property; empty: friction by mu, mean and sigma
  std::vector<PropertyCorrelation> correlation = {};  ///< of pairs of them; those that are not listed have none

  /// Whether something is drawn that varies from point to point.
  bool in_space() const {
    return properties.empty() ? sigma != 0.0 : std::ranges::any_of(properties, &PropertySpec::in_space);
  }
  /// Whether one realization differs from another.
  bool random() const {
    return properties.empty() ? sigma != 0.0 : std::ranges::any_of(properties, &PropertySpec::random);
  }
  bool along_x() const { return direction != FieldDirection::y; }  ///< whether the field varies along x
  bool along_y() const { return direction != FieldDirection::x; }
  bool operator==(const FieldSpec&) const = default;
};

}  // namespace talus
