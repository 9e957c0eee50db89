#pragma once
// Correlation functions of the Gaussian field, and their averages over the cell of a particle.
//
// r = sqrt((dx/ell_x)^2 + (dy/ell_y)^2). theta is the scale of fluctuation along an axis, the integral of the
// correlation over all lags along it (Vanmarcke 1983).
//
// | family                | rho                                                        | theta/ell           |
// |-----------------------|------------------------------------------------------------|---------------------|
// | exponential           | exp(-|dx|/ell_x - |dy|/ell_y)                 [Z20] Eq. 13 | 2                   |
// | exponential_isotropic | exp(-r)                                                    | 2                   |
// | squared_exponential   | exp(-r^2)                                                  | sqrt(pi) = 1.772    |
// | matern_3_2            | (1 + sqrt(3) r) exp(-sqrt(3) r)                            | 4/sqrt(3) = 2.309   |
// | matern_5_2            | (1 + sqrt(5) r + 5 r^2/3) exp(-sqrt(5) r)                  | 16/(3 sqrt(5)) = 2.385 |
// | cosine_exponential    | product over the axes of exp(-|d|/ell) cos(d/ell)          | 1                   |
//
// Exponential, squared exponential and cosine exponential: Vanmarcke 1983; Matern: Rasmussen & Williams,
// Gaussian Processes for Machine Learning, 2006, Eq. 4.17.

#include <numbers>

#include "math/vec2.hpp"

namespace talus {

enum class Covariance {
  exponential,
  exponential_isotropic,
  squared_exponential,
  matern_3_2,
  matern_5_2,
  cosine_exponential
};

/// theta / ell [-] of a family, as in the table above.
double scale_of_fluctuation_factor(Covariance family);

struct FieldSpec;

/// Correlation of a field with unit variance, as a function of the lag.
class Correlation {
 public:
  explicit Correlation(const FieldSpec& spec);

  /// @param lag  difference of two points, in the axes of the bedding [m]
  double operator()(Vec2 lag) const;
  /// Mean correlation of a point with the points of a square cell, by the midpoint rule in parts of a quarter of the
  /// correlation length or less.
  /// @param lag   from the point to the centre of the cell [m]
  /// @param cell  side of the cell [m]; 0: the correlation itself
  double with_cell(Vec2 lag, double cell) const;
  /// Variance of the mean over a square cell (Vanmarcke 1983):
  /// 4 integral_0^1 integral_0^1 (1-s)(1-t) rho(s h, t h) ds dt.
  /// @param cell  its side h [m]; 0: 1
  double cell_variance(double cell) const;

 private:
  Covariance family_;
  Vec2 inverse_;  ///< 1/ell along each axis [1/m]; 0 along an axis on which the field does not vary
};

}  // namespace talus
