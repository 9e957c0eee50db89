#pragma once
// The lognormal law of tan(phi): ln(tan phi) = mu + sigma Z.

namespace talus {

/// Mean and standard deviation of the logarithm.
struct LogParameters {
  double mu;     ///< mean of ln(tan phi) [-]; exp(mu) is the median of tan(phi)
  double sigma;  ///< standard deviation of ln(tan phi) [-], >= 0
};

/// Mean and coefficient of variation of the quantity itself.
struct Moments {
  double mean;  ///< [-], > 0
  double cov;   ///< standard deviation / mean [-], >= 0
};

/// sigma^2 = ln(1 + COV^2), mu = ln(mean) - sigma^2/2. ([Z20] Table 4 calls sigma/|mu| the COV; that is another
/// number.)
LogParameters log_parameters(Moments moments);

/// mean = exp(mu + sigma^2/2), COV = sqrt(exp(sigma^2) - 1); the sign of sigma does not matter.
Moments moments(LogParameters log);

}  // namespace talus
