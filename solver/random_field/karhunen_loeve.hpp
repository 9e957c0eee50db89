#pragma once
// Truncated Karhunen-Loeve expansion of a Gaussian field: Z = sum_k sqrt(lambda_k) f_k xi_k, [Z20] Eq. 11.

#include <cstddef>
#include <span>
#include <vector>

#include "math/vec2.hpp"
#include "random_field/field_spec.hpp"
#include "random_field/modes.hpp"

namespace talus {

/// A standard Gaussian field on a rectangle, expanded in products of one-dimensional modes.
class KarhunenLoeve {
 public:
  /// @param spec    what is asked for; its ranges have been checked
  /// @param domain  where the modes are solved [m]
  /// @param dx      side of the cells that `spec.cell_average` averages over [m]
  /// @throws ConfigError when the variance share takes too many modes
  KarhunenLoeve(const FieldSpec& spec, Box domain, double dx);

  std::size_t terms() const { return pairs_.size(); }
  /// sum lambda / (2 a_x 2 a_y) [-]
  double captured_variance() const { return captured_share(pairs_, x_, y_); }
  /// Variance of Z, averaged over the domain [-].
  double variance() const;
  /// The modes kept; xi[k] goes with pairs()[k].
  const std::vector<ModePair>& pairs() const { return pairs_; }

  /// Variance of Z at points [-], shape of `points`: V = sum_k scale_k^2 f_k^2. Smaller than 1 by what truncation and
  /// `cell_average` take away, and not the same everywhere.
  std::vector<double> variance(std::span<const Vec2> points) const;
  /// Z at points, shape of `points` [-]. The value at a point depends on that point and xi alone, bit by bit.
  std::vector<double> gaussian(std::span<const Vec2> points, std::span<const double> xi) const;

  /// What each coefficient makes of Z at one point: scale_k f_k(x), for every k.
  std::vector<double> modes_at(Vec2 point) const;

 private:
  /// The y modes that go with one x mode: `count` consecutive ones from `first` on, their coefficients from `offset`
  /// on.
  struct Row {
    std::size_t first = 0, count = 0, offset = 0;
  };

  /// What is made of the value of a mode: itself, or its square.
  using Shape = double (*)(double);

  void build_rows();
  std::vector<double> by_rows(const std::vector<double>& by_modes) const;
  void contract(double x, Shape shape, const std::vector<double>& coefficients, std::vector<double>& g) const;
  void evaluate(std::span<const Vec2> points, std::span<const std::size_t> chunk, Shape shape,
                const std::vector<double>& coefficients, std::vector<double>& z) const;
  std::vector<double> expand(std::span<const Vec2> points, Shape shape, const std::vector<double>& by_modes) const;

  AxisModes x_, y_;
  std::vector<ModePair> pairs_;
  std::vector<double> scale_;  ///< sqrt(lambda_k), times the averaging factors of the cell
  std::vector<Row> rows_;      ///< one per x mode
  std::size_t y_count_ = 0;    ///< number of y modes in use
};

}  // namespace talus
