#pragma once
// Kriging of the residuals of an unconditional field at data (Journel & Huijbregts 1978; Chiles & Delfiner 2012).

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "math/vec2.hpp"
#include "random_field/covariance.hpp"

namespace talus {

/// A measured value on the scale of the standard Gaussian field.
struct GaussianDatum {
  Vec2 x;        ///< where [m]
  double z;      ///< value [-]
  double error;  ///< its standard error [-], >= 0
};

/// Data nearer to one another than this are data at one point [m].
inline constexpr double same_point = 1e-6;

/// Data at one point made one: the mean weighted with 1/error^2, whose standard error is (sum 1/error^2)^-1/2. Where
/// one is exact, it stands.
std::vector<GaussianDatum> merged(std::span<const GaussianDatum> data);

/// Simple kriging of a field Y of mean 0 and covariance (1 - nugget) rho. A datum is Y plus noise of the variance
/// s^2 = error^2 + nugget: what varies from point to point is noise to the field, as the error of measurement is.
class Conditioning {
 public:
  /// @param data  at different points, in the axes of the bedding
  /// @throws ConfigError (/random_field/data) when two data are so near to one another that no field of this covariance
  /// meets both
  Conditioning(const Correlation& correlation, double nugget, std::vector<GaussianDatum> data);

  std::size_t size() const { return points_.size(); }
  /// Where the data are, in the axes of the bedding [m].
  const std::vector<Vec2>& points() const { return points_; }
  /// a = K^-1 (z + s eta - y), K = (1 - nugget) rho + s^2.
  /// @param y    an unconditional field at the data [-]
  /// @param eta  standard normal numbers: the errors of this realization
  Eigen::VectorXd coefficients(std::span<const double> y, std::span<const double> eta) const;
  /// What is added to the unconditional field at a point: sum_i c_i(x) a_i.
  /// @param cell  side of the square that values are averaged over [m]; 0: values at points
  double correction(Vec2 x, double cell, const Eigen::VectorXd& a) const;
  /// Variance of the conditional field at a point, of an unconditional one whose covariances are given: v - 2 w.c +
  /// w.(V
  /// + s^2) w with the kriging weights w.
  /// @param v       its variance there [-]
  /// @param c       its covariances with the data [-]
  /// @param v_data  its covariance matrix at the data [-]
  double variance(Vec2 x, double cell, double v, const Eigen::VectorXd& c, const Eigen::MatrixXd& v_data) const;
  /// c_i(x) = (1 - nugget) rho(x - x_i), averaged over the cell.
  Eigen::VectorXd covariances(Vec2 x, double cell) const;
  /// The covariance matrix at the data [-], without s^2.
  Eigen::MatrixXd data_covariance() const;

 private:
  Correlation correlation_;
  double continuous_;  ///< 1 - nugget
  std::vector<Vec2> points_;
  Eigen::VectorXd z_, noise_;  ///< values, and s
  Eigen::LLT<Eigen::MatrixXd> factor_;
};

}  // namespace talus
