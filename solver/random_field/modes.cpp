#include "random_field/modes.hpp"

#include <algorithm>
#include <boost/math/special_functions/sinc.hpp>
#include <cmath>
#include <numbers>
#include <queue>
#include <sstream>

#include "math/roots.hpp"
#include "support/error.hpp"

namespace talus {
namespace {

/// Walks all products in order of falling lambda. The heap holds the next product of each x mode that has been opened;
/// x mode i+1 is opened when (i, 0) is taken, since nothing of i+1 can come before.
class Products {
 public:
  Products(AxisModes& x, AxisModes& y) : x_(x), y_(y) { offer(0, 0); }

  bool empty() const { return heap_.empty(); }

  ModePair next() {
    const ModePair top = heap_.top();
    heap_.pop();
    offer(top.ix, top.iy + 1);
    if (top.iy == 0) offer(top.ix + 1, 0);
    return top;
  }

 private:
  struct After {
    bool operator()(const ModePair& p, const ModePair& q) const {
      return p.lambda != q.lambda ? p.lambda < q.lambda : p.ix > q.ix;
    }
  };

  void offer(std::size_t ix, std::size_t iy) {
    if (x_.has(ix) && y_.has(iy)) heap_.push({ix, iy, x_[ix].lambda * y_[iy].lambda});
  }

  AxisModes& x_;
  AxisModes& y_;
  std::priority_queue<ModePair, std::vector<ModePair>, After> heap_;
};

}  // namespace

double ExponentialMode::value(double x) const { return amplitude * (cosine ? std::cos(w * x) : std::sin(w * x)); }

double ExponentialMode::averaging_factor(double width) const { return boost::math::sinc_pi(w * width / 2); }

// odd n:  cos(w a)/ell - w sin(w a) = 0   (1/ell - w tan(w a) = 0 without its poles)   [Z20] Eq. 15
// even n: sin(w a)/ell + w cos(w a) = 0   (tan(w a)/ell + w = 0 without its poles)     [Z20] Eq. 21
// Either has one root in [(n-1) pi/(2a), n pi/(2a)]. With w a = (n-1) pi/2 + s both read
//   (a/ell) cos(s) - w a sin(s) = 0,  0 < s < pi/2,
// whose ends have opposite signs whatever a/ell, and sin(2 w a) = (+ odd, - even) sin(2 s) in the norms of Eqs. 14, 20.
ExponentialMode exponential_mode(int n, double a, double ell) {
  const double start = (n - 1) * (std::numbers::pi / 2);
  const auto residual = [&](double s) { return (a / ell) * std::cos(s) - (start + s) * std::sin(s); };
  const double s = bracketed_root(residual, 0.0, std::numbers::pi / 2);
  const double wa = start + s;
  const double w = wa / a;
  return {.w = w,
          .cosine = n % 2 == 1,
          .amplitude = 1 / std::sqrt(a * (1 + std::sin(2 * s) / (2 * wa))),
          .lambda = 2 * ell / (1 + w * w * ell * ell)};
}

int mode_number(int i, RootIntervals intervals) {
  if (intervals == RootIntervals::complete) return i;
  return i % 2 == 1 ? 2 * i - 1 : 2 * i;
}

AxisModes::AxisModes(double lo, double hi, double ell, RootIntervals intervals)
    : centre_((lo + hi) / 2), a_((hi - lo) / 2), ell_(ell), intervals_(intervals) {}

AxisModes AxisModes::constant() {
  AxisModes axis;
  axis.constant_ = true;
  axis.modes_ = {{.w = 0, .cosine = true, .amplitude = 1, .lambda = 1}};
  return axis;
}

const ExponentialMode& AxisModes::operator[](std::size_t index) {
  while (modes_.size() <= index) {
    const int i = static_cast<int>(modes_.size()) + 1;
    modes_.push_back(exponential_mode(mode_number(i, intervals_), a_, ell_));
  }
  return modes_[index];
}

std::vector<ModePair> largest_products(AxisModes& x, AxisModes& y, std::size_t count) {
  std::vector<ModePair> pairs;
  for (Products products(x, y); pairs.size() < count && !products.empty();) pairs.push_back(products.next());
  return pairs;
}

std::vector<ModePair> diagonal_products(AxisModes& x, AxisModes& y, std::size_t count) {
  std::vector<ModePair> pairs;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t ix = x.has(i) ? i : 0, iy = y.has(i) ? i : 0;
    pairs.push_back({ix, iy, x[ix].lambda * y[iy].lambda});
  }
  return pairs;
}

std::vector<ModePair> products_reaching(AxisModes& x, AxisModes& y, double share, std::size_t limit) {
  std::vector<ModePair> pairs;
  const double wanted = share * x.length() * y.length();
  double sum = 0;
  for (Products products(x, y); sum < wanted && !products.empty();) {
    if (pairs.size() == limit) {
      std::ostringstream text;
      text << "a share of " << share << " takes more than " << limit << " modes, which carry "
           << captured_share(pairs, x, y) << "; ask for less, or for circulant embedding, which truncates nothing";
      throw ConfigError("/random_field/variance_share", text.str());
    }
    pairs.push_back(products.next());
    sum += pairs.back().lambda;
  }
  return pairs;
}

double captured_share(const std::vector<ModePair>& pairs, const AxisModes& x, const AxisModes& y) {
  double sum = 0;
  for (const ModePair& pair : pairs) sum += pair.lambda;
  return std::min(1.0, sum / (x.length() * y.length()));
}

}  // namespace talus
