#pragma once
// Distributions of one property at a point, as functions of a standard normal number.

#include "random_field/property_spec.hpp"

namespace talus {

/// Standard normal numbers beyond this one are never drawn: their probability is 1e-15.
inline constexpr double farthest = 8.0;

/// A distribution X = F^-1(Phi(Z)), Z standard normal. Made by the functions below, which throw std::domain_error with
/// the range that is allowed where there is no such distribution. Pure; safe to use from several threads at once.
struct Marginal {
  MarginalKind kind = MarginalKind::constant;
  double mean = 0.0;   ///< of X
  double stdev = 0.0;  ///< of X
  double a = 0.0;      ///< mean of ln X | parent's mean | first exponent of the beta distribution
  double b = 0.0;      ///< standard deviation of ln X | the parent's | second exponent
  double low = 0.0;    ///< bounds of X; infinite where there is none
  double high = 0.0;

  double cov() const { return mean != 0.0 ? stdev / mean : 0.0; }
  /// X of a standard normal number, rising.
  double value(double z) const;
  /// The standard normal number of a value: value(z) = x. @param x  from value(-farthest) to value(farthest)
  /// @throws std::domain_error otherwise
  double normal_number(double x) const;
  /// dX/dz, by central differences.
  double slope(double z) const;
  /// The same distribution of an average that keeps a share of the variance: the mean, the kind and the bounds stay.
  /// @param share  of the variance [-], in (0, 1]; of ln X for the lognormal distribution
  Marginal averaged(double share) const;
};

/// X = value
Marginal constant_marginal(double value);
/// ln X is normal. @param mean  of X, > 0; @param log_stdev  of ln X, >= 0
Marginal lognormal_marginal(double mean, double log_stdev);
/// Normal, truncated at `low` and `high`, which may be infinite; `mean` and `stdev` are those of the truncated one.
Marginal normal_marginal(double mean, double stdev, double low, double high);
/// (X - low)/(high - low) is beta distributed.
Marginal beta_marginal(double mean, double stdev, double low, double high);
Marginal uniform_marginal(double low, double high);

/// The distribution that a specification gives in a material.
/// @param of_material  value of the property in the material, the mean unless the specification states one
/// @throws std::domain_error with the range that is allowed, in the unit of property_names
Marginal make_marginal(const PropertySpec& spec, double of_material);

}  // namespace talus
