#pragma once
// Correlation of properties that are not normal: Nataf's transformation (Liu & Der Kiureghian 1986, Probab. Eng. Mech.
// 1, 105-112). Two properties X = F^-1(Phi(Z)) with the correlation rho have standard normal Z with another one, rho':
//
//   rho = E[(X1 - m1)(X2 - m2)]/(s1 s2) = sum_{k >= 1} c_k d_k rho'^k,   c_k = E[X1 he_k(Z)]/s1, d_k = E[X2 he_k(Z)]/s2
//
// with the orthonormal Hermite polynomials he_k (Mehler 1866): the double integral is a power series of single ones.

#include "random_field/marginal.hpp"

namespace talus {

/// Correlation of two properties of which the normal numbers have the correlation `gaussian`, in [-1, 1].
/// Marginals that are constant are not allowed.
double correlation_after_marginals(const Marginal& a, const Marginal& b, double gaussian);

/// The correlations that two properties can have.
struct Attainable {
  double least, most;
};
Attainable attainable_correlation(const Marginal& a, const Marginal& b);

/// rho' of a correlation rho of the properties.
/// @param rho  within attainable_correlation(a, b)
/// @throws std::domain_error with the attainable range otherwise
double gaussian_correlation(const Marginal& a, const Marginal& b, double rho);

}  // namespace talus
