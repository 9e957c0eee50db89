#include "random_field/truncation.hpp"

#include <algorithm>
#include <queue>
#include <sstream>

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
