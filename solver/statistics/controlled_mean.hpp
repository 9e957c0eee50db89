#pragma once
// The mean of a sample whose values depend on variables of known mean: what these variables explain of the sample does
// not count as sampling error (control variates; Lavenberg & Welch 1981). Pure functions.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "statistics/regression.hpp"
#include "statistics/sample.hpp"

namespace talus {

/// A coefficient of the regression with its interval, in units of the sample per unit of the variable.
struct Slope {
  std::size_t variable = 0;  ///< its place among the controls
  double value = 0.0;
  Interval ci95;
};

/// The regression y = mean + sum_k slope_k c_k + residual. A control has the mean 0, so the intercept is the mean of y.
struct ControlledMean {
  double mean = 0.0;
  double standard_error = 0.0;
  Interval ci95;                ///< Student with n - K - 1 degrees of freedom
  std::vector<Slope> slopes;    ///< of the K controls that are used
  double residual_share = 1.0;  ///< variance of the residuals over that of y, each over its degrees of freedom [-]
  double worth = 0.0;           ///< how many runs would give the plain mean this standard error
  std::vector<std::vector<double>> slope_covariance;  ///< K x K, HC3
  double student = 0.0;  ///< t_{0.975, n - K - 1}, which makes a standard error an interval
};

/// The mean of `y` by regression on the first K controls, K the number of them whose leave-one-out error is least
/// (PRESS; Allen 1974). Variances are estimated from the residuals over (1 - leverage), HC3 of MacKinnon & White 1985,
/// which holds where the scatter depends on the controls. The choice of K looks at the sample, so the controls must
/// come in an order that does not: the most important first, by what is known beforehand. A control that is constant in
/// the sample or a combination of those before it is passed over.
/// @param y         n values
/// @param controls  of each control its n values; each has the mean 0
/// @return unset where n < 2
/// @throws std::invalid_argument where a control has not n values
std::optional<ControlledMean> controlled_mean(std::span<const double> y, std::span<const std::vector<double>> controls);
/// The same of a regression already made. @param y  its n values, n - K - 1 >= 1
ControlledMean controlled_mean(const Regression& of, std::span<const double> y);

}  // namespace talus
