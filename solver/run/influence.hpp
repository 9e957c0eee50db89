#pragma once
// Where the soil matters: what the local value of a random field says of a quantity of a study.

#include <span>
#include <string>
#include <vector>

#include "case/load.hpp"
#include "study/regression_summary.hpp"

namespace talus {

/// One field of a study. With Z(x) the normal field of the property, such as ln(tan phi) before it is scaled, the
/// influence at x is Cov(quantity, Z(x)) / stdev(Z(x)) = sum_k b_k a_k(x) / stdev(Z(x)): by how much the quantity is
/// larger on average where Z(x) is one standard deviation above its mean, with what is correlated with the soil there.
/// b_k are the slopes of the regression, a_k(x) the modes: Z(x) = mean + sum_k a_k(x) xi_k.
struct Influence {
  std::size_t block = 0;                  ///< index into Plan::draws
  std::vector<double> value, half_width;  ///< at each point, per standard deviation; of the 95 % interval
};

/// The influence of each field, of properties drawn once excepted, of which a number serves as regressor.
/// @param points      [m]
/// @param regression  done, of a study of `problem`
/// @return nothing where data condition several properties: their modes are then not those of one field
/// @throws ConfigError when the field cannot be built
std::vector<Influence> influence_at(const Case& problem, std::span<const Vec2> points, const Plan& plan,
                                    const RegressionSummary& regression);

}  // namespace talus
