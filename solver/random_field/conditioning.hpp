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

/// A measured value on the scale of a standard Gaussian field.
struct GaussianDatum {
  Vec2 x;                               ///< where [m]
  double z;                             ///< value [-]
  double error;                         ///< its standard error [-], >= 0
  std::vector<double> weights = {1.0};  ///< w_f: the datum is of sum_f w_f Y_f, Y_f independent fields; sum w_f^2 = 1
};

/// Data nearer to one another than this are data at one point [m].
inline constexpr double same_point = 1e-6;

/// Data of one field at one point made one: the mean weighted with 1/error^2, whose standard error is (sum
/// 1/error^2)^-1/2. Where one is exact, it stands.
std::vector<GaussianDatum> merged(std::span<const GaussianDatum> data);

/// Simple kriging of independent fields Y_f of mean 0 and covariance (1 - nugget) rho, together. A datum is sum_f w_f
/// Y_f plus noise of the variance s^2 = error^2 + nugget: what varies from point to point is noise to the fields, as
/// the error of measurement is. The data have the covariance matrix K_ij = (w_i . w_j) (1 - nugget) rho(x_i - x_j) +
/// S_ij, with S = s^2 on the diagonal, and nugget (w_i . w_j) between data at one point, which share what varies there.
class Conditioning {
 public:
  /// @param data  as merged() returns them, in the axes of the bedding, with weights of one number of fields
  /// @throws ConfigError (/random_field/data) when two data are so near to one another that no field of this covariance
  /// meets both
  Conditioning(const Correlation& correlation, double nugget, std::vector<GaussianDatum> data);

  std::size_t size() const { return points_.size(); }
  /// Where the data are, in the axes of the bedding [m].
  const std::vector<Vec2>& points() const { return points_; }
  /// a = K^-1 (z + N eta - y), N N^T = S.
  /// @param y    sum_f w_f Y_f at the data, of unconditional fields [-]
  /// @param eta  standard normal numbers: the errors of this realization
  Eigen::VectorXd coefficients(std::span<const double> y, std::span<const double> eta) const;
  /// w_if, [datum][field].
  const Eigen::MatrixXd& weights() const { return weights_; }
  /// The part of a that is of one field: w_if a_i.
  Eigen::VectorXd of_field(const Eigen::VectorXd& a, std::size_t field) const;
  /// What is added to an unconditional field at a point: sum_i c_i(x) a_i, with a of the field.
  /// @param cell  side of the square that values are averaged over [m]; 0: values at points
  double correction(Vec2 x, double cell, const Eigen::VectorXd& a) const;
  /// Variance of a conditional field at a point, of an unconditional one whose covariances are given: v - 2 l.c +
  /// l.(V + S) l with the kriging weights l = K^-1 k.
  /// @param k       its covariances with the data that K goes with [-]
  /// @param v       its variance there [-]
  /// @param c       its covariances with the data as they are drawn [-]
  /// @param v_data  the covariance matrix of the data as they are drawn [-], without S
  double variance(const Eigen::VectorXd& k, double v, const Eigen::VectorXd& c, const Eigen::MatrixXd& v_data) const;
  /// c_i(x) = (1 - nugget) rho(x - x_i), averaged over the cell.
  Eigen::VectorXd covariances(Vec2 x, double cell) const;
  /// w_i . w for every datum: the correlation of what it measures with sum_f w_f Y_f at the same point.
  Eigen::VectorXd common(std::span<const double> weights) const;
  /// w_i . w_j for every pair of data.
  Eigen::MatrixXd common() const { return weights_ * weights_.transpose(); }

 private:
  Correlation correlation_;
  double continuous_;  ///< 1 - nugget
  std::vector<Vec2> points_;
  Eigen::VectorXd z_;        ///< values
  Eigen::MatrixXd weights_;  ///< [datum][field]
  Eigen::MatrixXd noise_;    ///< N, lower triangular
  Eigen::LLT<Eigen::MatrixXd> factor_;
};

}  // namespace talus
