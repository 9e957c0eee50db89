#pragma once
// How close arrays of rates must be.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace talus::testing_support {

/// Every value within `tolerance` of the largest expected one.
inline void expect_close(const std::vector<double>& actual, const std::vector<double>& expected, double tolerance,
                         const char* what) {
  double scale = 0.0;
  for (const double e : expected) scale = std::max(scale, std::abs(e));
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t i = 0; i < actual.size(); ++i)
    ASSERT_NEAR(actual[i], expected[i], tolerance * scale) << what << " of " << i;
}

}  // namespace talus::testing_support
