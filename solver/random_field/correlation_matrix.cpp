#include "random_field/correlation_matrix.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace talus {
namespace {

using Matrix = Eigen::MatrixXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Decomposition = Eigen::SelfAdjointEigenSolver<Matrix>;

Matrix matrix_of(const CorrelationMatrix& of) {
  const auto n = static_cast<Eigen::Index>(of.size());
  Matrix m(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) m(i, j) = of(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
  return m;
}

/// The nearest matrix whose eigenvalues are at least `least`.
Matrix with_eigenvalues_from(double least, const Matrix& m) {
  const Decomposition spectrum(m);
  const Matrix& v = spectrum.eigenvectors();
  return v * spectrum.eigenvalues().cwiseMax(least).asDiagonal() * v.transpose();
}

}  // namespace

CorrelationMatrix::CorrelationMatrix(std::size_t n) : n_(n), values_(n * n, 0.0) {
  for (std::size_t i = 0; i < n; ++i) values_[i * n + i] = 1.0;
}

bool CorrelationMatrix::positive_definite() const {
  return n_ == 0 || Decomposition(matrix_of(*this), Eigen::EigenvaluesOnly).eigenvalues().minCoeff() > 1e-8;
}

CorrelationMatrix CorrelationMatrix::nearest_valid(double least_eigenvalue) const {
  Matrix y = matrix_of(*this), correction = Matrix::Zero(y.rows(), y.cols());
  for (int k = 0; k < 1000; ++k) {
    const Matrix before = y, r = y - correction, x = with_eigenvalues_from(least_eigenvalue, r);
    correction = x - r;
    y = x;
    y.diagonal().setOnes();
    if ((y - before).norm() < 1e-12) break;
  }
  CorrelationMatrix nearest(n_);
  for (std::size_t i = 0; i < n_; ++i)
    for (std::size_t j = 0; j < i; ++j)
      nearest.set(i, j, y(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
  return nearest;
}

std::vector<double> CorrelationMatrix::lower_factor() const {
  const RowMajor l = Eigen::LLT<Matrix>(matrix_of(*this)).matrixL();
  return {l.data(), l.data() + l.size()};
}

}  // namespace talus
