#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "math/roots.hpp"

namespace talus {
namespace {

TEST(BracketedRoot, ToTheLastBits) {
  EXPECT_DOUBLE_EQ(bracketed_root([](double x) { return x * x - 2; }, 0, 2), std::numbers::sqrt2);
  EXPECT_DOUBLE_EQ(bracketed_root([](double x) { return std::cos(x); }, 1, 2), std::numbers::pi / 2);
}

TEST(BracketedRoot, RootAtAnEnd) {
  EXPECT_EQ(bracketed_root([](double x) { return x - 1; }, 1, 2), 1);
  EXPECT_EQ(bracketed_root([](double x) { return x - 2; }, 1, 2), 2);
}

TEST(BracketedRoot, RefusesAnIntervalWithoutAChangeOfSign) {
  EXPECT_THROW(bracketed_root([](double x) { return x * x + 1; }, -1, 1), std::domain_error);
}

}  // namespace
}  // namespace talus
