#pragma once
// Arithmetic that the laws need, under one name for every number type: here for double; for vectors of single precision
// it is part of Lanes (sph/lanes-inl.hpp).

#include <cmath>

namespace talus {

using std::abs;
using std::sqrt;

/// a b + c; in double precision rounded twice, so that results do not depend on the processor.
constexpr double fma(double a, double b, double c) { return a * b + c; }
/// a b - c
constexpr double fms(double a, double b, double c) { return a * b - c; }
/// c - a b
constexpr double fnma(double a, double b, double c) { return c - a * b; }

constexpr double min(double a, double b) { return a < b ? a : b; }
constexpr double max(double a, double b) { return a > b ? a : b; }

/// a where the condition holds, b elsewhere.
constexpr double select(bool condition, double a, double b) { return condition ? a : b; }
/// a where the condition holds, zero elsewhere.
constexpr double select_or_zero(bool condition, double a) { return condition ? a : 0.0; }
/// Whether the condition holds anywhere.
constexpr bool any(bool condition) { return condition; }

}  // namespace talus
