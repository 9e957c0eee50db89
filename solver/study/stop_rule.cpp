#include "study/stop_rule.hpp"

#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <cstdint>

namespace talus {

std::optional<std::int64_t> stopping_size(const Plan& plan, const std::vector<Record>& records) {
  if (!plan.study.stop_half_width) return std::nullopt;
  // Mean and sum of squares run along (Welford 1962), so that every prefix is looked at in one pass.
  std::int64_t done = 0;
  double mean = 0.0, square = 0.0;
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (records[i].index != static_cast<std::int64_t>(i)) return std::nullopt;
    if (!records[i].done) continue;
    const double x = records[i].measures.influence_zone;
    const double n = static_cast<double>(++done);
    const double step = x - mean;
    mean += step / n;
    square += step * (x - mean);
    if (done < least_to_stop) continue;
    const double t = boost::math::quantile(boost::math::complement(boost::math::students_t(n - 1.0), 0.025));
    if (t * std::sqrt(square / (n - 1.0) / n) <= *plan.study.stop_half_width) return static_cast<std::int64_t>(i) + 1;
  }
  return std::nullopt;
}

}  // namespace talus
