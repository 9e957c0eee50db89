#include "study/estimator.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace talus {
void RunningMean::add(double x) {
  const double step = x - mean;
  mean += step / static_cast<double>(++n);
  square += step * (x - mean);
}

std::optional<double> RunningMean::half_width() const {
  if (n < 2) return std::nullopt;
  const double count = static_cast<double>(n);
  const double t = boost::math::quantile(boost::math::complement(boost::math::students_t(count - 1.0), 0.025));
  return t * std::sqrt(square / (count - 1.0) / count);
}

void StopRule::add(std::int64_t index, std::optional<double> influence_zone) {
  if (!half_width_ || size_ || index != next_) return;
  ++next_;
  if (!influence_zone) return;
  zones_.add(*influence_zone);
  if (zones_.n >= least_to_stop && *zones_.half_width() <= *half_width_) size_ = next_;
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
  if (influence_zone)
    zones_.add(*influence_zone);
  else
    ++failed_;
}

Estimator::Decision Estimator::decision() const {
  if (too_many_failed(failed_, done(), planned(), max_failed_share_)) return Decision::too_many_failed;
  return stop_.size() && *stop_.size() < realizations_ ? Decision::enough : Decision::go_on;
}

bool Estimator::is_farthest(std::int64_t index, double influence_zone) const {
  return farthest_index_ < 0 || influence_zone > farthest_ || (influence_zone == farthest_ && index <= farthest_index_);
}

}  // namespace talus
