#pragma once
// Which products of one-dimensional modes a two-dimensional expansion keeps: [Z20] Eqs. 22, 23.

#include <cstddef>
#include <vector>

#include "random_field/exponential_modes.hpp"

namespace talus {

/// The two-dimensional mode f_ix(x) f_iy(y).
struct ModePair {
  std::size_t ix;  ///< index into the modes along x, from 0
  std::size_t iy;  ///< index into the modes along y, from 0
  double lambda;   ///< lambda_ix lambda_iy [m2], [Z20] Eq. 22
};

/// More modes than this are refused: draws and evaluation would take longer than circulant embedding, which truncates
/// nothing.
inline constexpr std::size_t max_modes = 1'000'000;

/// The `count` largest products, largest first; equal ones in order of ix. Takes O(count log count) and solves only the
/// one-dimensional modes it needs. Fewer when there are no more (both axes constant).
std::vector<ModePair> largest_products(AxisModes& x, AxisModes& y, std::size_t count);

/// The products (0,0), (1,1), ...: what [Z20] most likely used. Factors of equal index have equal parity, so that
/// f(-x,-y) = f(x,y): such a field is point-symmetric about the middle of the domain ([Z20] Fig. 3d). Along a single
/// axis (the other one constant) these are the `count` leading modes.
std::vector<ModePair> diagonal_products(AxisModes& x, AxisModes& y, std::size_t count);

/// As few of the largest products as carry `share` of the variance, sum lambda >= share x.length() y.length().
/// @throws ConfigError (/random_field/variance_share) when `limit` modes do not reach the share
std::vector<ModePair> products_reaching(AxisModes& x, AxisModes& y, double share, std::size_t limit = max_modes);

/// sum lambda / (x.length() y.length()) [-], in (0, 1].
double captured_share(const std::vector<ModePair>& pairs, const AxisModes& x, const AxisModes& y);

}  // namespace talus
