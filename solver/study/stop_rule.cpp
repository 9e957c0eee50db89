#include "study/stop_rule.hpp"

#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace talus {

void StopRule::add(std::int64_t index, std::optional<double> influence_zone) {
  if (!half_width_ || size_ || index != next_) return;
  ++next_;
  if (!influence_zone) return;
  const double n = static_cast<double>(++done_);
  const double step = *influence_zone - mean_;
  mean_ += step / n;
  square_ += step * (*influence_zone - mean_);
  if (done_ < least_to_stop) return;
  const double t = boost::math::quantile(boost::math::complement(boost::math::students_t(n - 1.0), 0.025));
  if (t * std::sqrt(square_ / (n - 1.0) / n) <= *half_width_) size_ = next_;
}

std::optional<std::int64_t> stopping_size(const Plan& plan, const std::vector<Record>& records) {
  StopRule rule(plan.study.stop_half_width);
  for (const Record& r : records) rule.add(r.index, r.done ? std::optional(r.measures.influence_zone) : std::nullopt);
  return rule.size();
}

}  // namespace talus
