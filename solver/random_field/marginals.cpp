#include "random_field/marginals.hpp"

#include <cmath>
#include <stdexcept>

#include "random_field/random_field.hpp"

namespace talus {

LogParameters log_parameters(Moments moments) {
  const double variance = std::log1p(moments.cov * moments.cov);
  return {.mu = std::log(moments.mean) - variance / 2, .sigma = std::sqrt(variance)};
}

Moments moments(LogParameters log) {
  const double variance = log.sigma * log.sigma;
  return {.mean = std::exp(log.mu + variance / 2), .cov = std::sqrt(std::expm1(variance))};
}

std::vector<double> lognormal(std::span<const double> gaussian, std::span<const double> mu, double sigma) {
  if (mu.size() != 1 && mu.size() != gaussian.size())
    throw std::invalid_argument("lognormal: mu is one value, or one per point");
  std::vector<double> value(gaussian.size());
  for (std::size_t i = 0; i < value.size(); ++i) value[i] = std::exp(mu[mu.size() == 1 ? 0 : i] + sigma * gaussian[i]);
  return value;
}

}  // namespace talus
