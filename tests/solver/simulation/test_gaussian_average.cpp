#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "simulation/gaussian_average.hpp"

namespace talus {
namespace {

/// A jittered lattice of spacing 0.1 m over 4 m x 2 m, with weights and values that differ.
struct Points {
  std::vector<double> x, y, weight, value;

  Points() {
    std::mt19937 engine(11);
    std::uniform_real_distribution<double> u(0.0, 1.0);
    for (int i = 0; i < 40; ++i)
      for (int j = 0; j < 20; ++j) {
        x.push_back(0.1 * (i + 0.4 * u(engine)));
        y.push_back(0.1 * (j + 0.4 * u(engine)));
        weight.push_back(1.0 + u(engine));
        value.push_back(i > 20 ? u(engine) : 0.0);
      }
  }
};

TEST(GaussianAverage, IsTheSumOverAllPairs) {
  const Points p;
  const double sigma = 0.2;
  const std::vector<double> found = gaussian_average(p.x, p.y, p.weight, p.value, sigma);
  double largest = 0.0;
  for (std::size_t i = 0; i < p.x.size(); ++i) {
    double sum = 0.0, product = 0.0;
    for (std::size_t j = 0; j < p.x.size(); ++j) {
      const double r2 = std::pow(p.x[i] - p.x[j], 2) + std::pow(p.y[i] - p.y[j], 2);
      const double w = p.weight[j] * std::exp(-r2 / (2 * sigma * sigma));
      sum += w;
      product += w * p.value[j];
    }
    largest = std::max(largest, std::abs(found[i] - product / sum));
  }
  EXPECT_LT(largest, 0.01);
}

TEST(GaussianAverage, KeepsWhatIsTheSameEverywhere) {
  const Points p;
  const std::vector<double> same(p.x.size(), 0.7);
  for (const double v : gaussian_average(p.x, p.y, p.weight, same, 0.3)) EXPECT_NEAR(v, 0.7, 1e-12);
  EXPECT_TRUE(gaussian_average({}, {}, {}, {}, 0.3).empty());
}

TEST(GaussianAverage, ABandHasItsDisplacementOverTheWidthWhateverItsOwnWidthAndSlope) {
  // sigma = width/sqrt(2 pi): the peak of the average of a band of strain 1/w and of thickness w is 1/width.
  const double width = 1.0, sigma = width / std::sqrt(2.0 * std::numbers::pi);
  for (const double slope : {0.0, 0.5, 1.0})
    for (const double thickness : {0.1, 0.2}) {
      std::vector<double> x, y, value;
      for (int i = 0; i < 160; ++i)
        for (int j = 0; j < 160; ++j) {
          x.push_back(0.05 * i);
          y.push_back(0.05 * j);
          const double across = (y.back() - 4.0 - slope * (x.back() - 4.0)) / std::sqrt(1.0 + slope * slope);
          value.push_back(std::abs(across + 0.01) < 0.5 * thickness ? 1.0 / thickness : 0.0);
        }
      const std::vector<double> weight(x.size(), 1.0), average = gaussian_average(x, y, weight, value, sigma);
      double peak = 0.0;
      for (std::size_t i = 0; i < x.size(); ++i)
        if (std::abs(x[i] - 4.0) < 1.0) peak = std::max(peak, average[i]);       // away from the edges
      EXPECT_NEAR(peak, 1.0 / width, 0.1 / width) << slope << " " << thickness;  // the band of points is uneven
    }
}

}  // namespace
}  // namespace talus
