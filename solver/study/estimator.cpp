#include "study/estimator.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace talus {
namespace {

/// Adds the n-th value to a mean and a sum of squared deviations (Welford 1962).
void welford(double x, std::int64_t n, double& mean, double& square) {
  const double step = x - mean;
  mean += step / static_cast<double>(n);
  square += step * (x - mean);
}

/// t_{0.975, n-1} s / sqrt(n), n >= 2
double half_width(double square, std::int64_t n) {
  const double count = static_cast<double>(n);
  const double t = boost::math::quantile(boost::math::complement(boost::math::students_t(count - 1.0), 0.025));
  return t * std::sqrt(square / (count - 1.0) / count);
}

}  // namespace

std::int64_t rank_of(const RunKey& key, std::int64_t replicates) {
  if (key.is_replicate()) return key.index;
  return key.index == 0 ? 0 : replicates + key.index;
}

RunKey run_of_rank(std::int64_t rank, std::int64_t replicates) {
  if (rank == 0) return realization(0);
  return rank <= replicates ? replicate(rank) : realization(rank - replicates);
}

bool too_many_failed(std::int64_t failed, std::int64_t done, std::int64_t planned, double max_failed_share) {
  return static_cast<double>(failed) > max_failed_share * static_cast<double>(planned) ||
         (done == 0 && failed > 0 && failed >= planned);
}

Estimator::Estimator(const StudySpec& spec, std::int64_t first, std::int64_t end)
    : max_failed_share_(spec.max_failed_share),
      realizations_(spec.realizations),
      first_(first),
      end_(end),
      stop_(spec.stop_half_width) {}

void Estimator::add(const RunKey& key, std::optional<double> influence_zone) {
  if (key.is_replicate()) {
    ++replicates_;
    return;
  }
  ahead_.emplace(key.index, influence_zone);
  for (auto first = ahead_.begin(); first != ahead_.end() && first->first == next_; first = ahead_.erase(first))
    stop_.add(next_++, first->second);
  if (influence_zone && is_farthest(key.index, *influence_zone)) {
    farthest_ = *influence_zone;
    farthest_index_ = key.index;
  }
  if (key.index < first_ || key.index >= end_) return;
  if (!influence_zone) {
    ++failed_;
    return;
  }
  welford(*influence_zone, ++done_, mean_, square_);
}

Estimator::Decision Estimator::decision() const {
  if (too_many_failed(failed_, done_, planned(), max_failed_share_)) return Decision::too_many_failed;
  return stop_.size() && *stop_.size() < realizations_ ? Decision::enough : Decision::go_on;
}

bool Estimator::is_farthest(std::int64_t index, double influence_zone) const {
  return farthest_index_ < 0 || influence_zone > farthest_ || (influence_zone == farthest_ && index <= farthest_index_);
}

std::optional<double> Estimator::mean() const { return done_ > 0 ? std::optional(mean_) : std::nullopt; }

std::optional<double> Estimator::mean_half_width() const {
  return done_ > 1 ? std::optional(half_width(square_, done_)) : std::nullopt;
}

}  // namespace talus
