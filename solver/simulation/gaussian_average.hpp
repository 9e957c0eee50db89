#pragma once
// Averages over a length that is longer than the spacing of the particles.

#include <span>
#include <vector>

namespace talus {

/// Weighted average around each point, sum_j w_j v_j W_ij / sum_j w_j W_ij with W = exp(-r^2/(2 sigma^2)). The sums run
/// over a grid of sigma/2 with bilinear weights, whose spread is taken off that of W; they differ from the sums over
/// all pairs by less than a hundredth of the largest value where there are points in every cell.
/// @param x, y    of the points [m]
/// @param weight  > 0
/// @param sigma   [m], > 0
/// @return as many values as there are points. Pure; thread-safe; on one thread.
std::vector<double> gaussian_average(std::span<const double> x, std::span<const double> y,
                                     std::span<const double> weight, std::span<const double> value, double sigma);

}  // namespace talus
