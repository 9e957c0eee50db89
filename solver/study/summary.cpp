#include "study/summary.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>

#include "monte_carlo/histogram.hpp"
#include "monte_carlo/statistics.hpp"
#include "study/stop_rule.hpp"

namespace talus {
namespace {

using nlohmann::ordered_json;

constexpr std::array<double, 9> probabilities{0.01, 0.05, 0.1, 0.25, 0.5, 0.75, 0.9, 0.95, 0.99};
constexpr double exceedance_points = 40.0;  // about so many along the curve

ordered_json json(const std::optional<double>& value) { return value ? ordered_json(*value) : ordered_json(); }
ordered_json json(const Interval& interval) { return ordered_json::array({json(interval.lo), json(interval.hi)}); }
ordered_json json(const std::optional<Interval>& interval) { return interval ? json(*interval) : ordered_json(); }

std::vector<double> values(const std::vector<Record>& records, double Measures::*member) {
  std::vector<double> all;
  for (const Record& r : records)
    if (r.done) all.push_back(r.measures.*member);
  return all;
}

ordered_json moments_json(const SampleMoments& m) {
  return {{"n", m.n},
          {"mean", json(m.mean)},
          {"mean_ci95", json(m.mean_ci95)},
          {"stdev", json(m.stdev)},
          {"stdev_ci95", json(m.stdev_ci95)},
          {"skewness", json(m.skewness)},
          {"excess_kurtosis", json(m.excess_kurtosis)},
          {"min", json(m.min)},
          {"max", json(m.max)}};
}

ordered_json quantiles_json(const std::vector<double>& sorted, std::int64_t failed) {
  ordered_json all = ordered_json::array();
  if (sorted.empty()) return all;
  for (double p : probabilities) {
    const Quantile q = quantile(sorted, p, failed);
    all.push_back({{"p", q.p},
                   {"value", q.value},
                   {"ci95", json(q.ci95)},
                   {"if_failed_all_below", json(q.if_failed_below)},
                   {"if_failed_all_above", json(q.if_failed_above)}});
  }
  return all;
}

ordered_json histogram_json(const std::vector<double>& sorted, const std::vector<double>& given) {
  const std::vector<double> edges = given.empty() ? round_edges(sorted) : given;
  const Histogram h = edges.empty() ? Histogram{} : histogram(sorted, edges);
  return {{"edges", h.edges},
          {"counts", h.counts},
          {"underflow", h.underflow},
          {"overflow", h.overflow},
          {"convention", histogram_convention},
          {"edges_given", !given.empty()}};
}

ordered_json exceedance_json(const std::vector<double>& sorted, std::int64_t failed) {
  ordered_json all = ordered_json::array();
  if (sorted.empty()) return all;
  const double range = sorted.back() - sorted.front();
  const auto points = round_grid(sorted.front(), sorted.back(), range > 0.0 ? range / exceedance_points : 0.1);
  for (const Exceedance& e : exceedance(sorted, points, failed))
    all.push_back({{"x", e.x},
                   {"k", e.k},
                   {"n", e.n},
                   {"p", e.p},
                   {"lo", e.lo},
                   {"hi", e.hi},
                   {"p_if_failed_none_exceed", e.p},
                   {"p_if_failed_all_exceed", e.p_if_failed_all_exceed}});
  return all;
}

/// One measure: its statistics, and how much of its spread is the numerics' own.
ordered_json quantity_json(const Plan& plan, const std::vector<Record>& runs, const std::vector<Record>& floor,
                           const MeasureColumn& column) {
  std::vector<double> sample = values(runs, column.member);
  const SampleMoments m = moments(sample);
  const SampleMoments noise = moments(values(floor, column.member));
  const std::optional<Ratio> ratio = stdev_ratio(m, noise);
  const auto failed = static_cast<std::int64_t>(runs.size() - sample.size());
  // Given edges are run-out distances; the centre of mass lies elsewhere.
  const bool front = column.member != &Measures::centre_of_mass_x;

  ordered_json quantity = moments_json(m);
  std::sort(sample.begin(), sample.end());
  quantity["quantiles"] = quantiles_json(sample, failed);
  quantity["histogram"] = histogram_json(sample, front ? plan.study.histogram_edges : std::vector<double>{});
  quantity["exceedance"] = exceedance_json(sample, failed);
  quantity["noise_floor_stdev"] = json(noise.stdev);
  quantity["noise_floor_stdev_ci95"] = json(noise.stdev_ci95);
  quantity["stdev_over_noise_floor"] = ratio ? ordered_json(ratio->value) : ordered_json();
  quantity["stdev_over_noise_floor_ci95"] = ratio ? json(ratio->ci95) : ordered_json();
  return quantity;
}

ordered_json mean_phi_json(const std::vector<Record>& runs) {
  std::vector<double> phi;
  for (const Record& r : runs)
    if (r.done) phi.push_back(r.mean_phi_deg);
  ordered_json all = moments_json(moments(phi));
  all["correlation_with_influence_zone"] = json(correlation(phi, values(runs, &Measures::influence_zone)));
  return all;
}

/// Indices without a record as inclusive ranges.
ordered_json missing_json(const std::vector<Record>& runs, std::int64_t until) {
  ordered_json ranges = ordered_json::array();
  std::int64_t next = 0;
  const auto gap_before = [&](std::int64_t index) {
    if (next < index) ranges.push_back({next, index - 1});
    next = index + 1;
  };
  for (const Record& r : runs) gap_before(r.index);
  gap_before(until);
  return ranges;
}

ordered_json failures_json(const std::vector<Record>& runs) {
  ordered_json all = ordered_json::array();
  for (const Record& r : runs)
    if (!r.done) all.push_back({{"index", r.index}, {"reason", r.reason}});
  return all;
}

ordered_json realizations_json(const Plan& plan, const std::vector<Record>& runs) {
  const auto failed = std::count_if(runs.begin(), runs.end(), [](const Record& r) { return !r.done; });
  const std::optional<std::int64_t> stopped = stopping_size(plan, runs);
  const std::int64_t planned = plan.study.realizations;
  const bool early = stopped && *stopped < planned;
  const ordered_json missing = missing_json(runs, early ? *stopped : planned);
  return {{"planned", planned},
          {"done", static_cast<std::int64_t>(runs.size()) - failed},
          {"failed", failed},
          {"complete", missing.empty()},
          {"stopped_early", early},
          {"missing", missing},
          {"max_failed_share", plan.study.max_failed_share},
          {"stop_when_ci_half_width_below_m", json(plan.study.stop_half_width)}};
}

/// Time and shares that belong to the runs as a whole.
ordered_json effort_json(const std::vector<Record>& runs) {
  double seconds = 0.0;
  std::int64_t steps = 0;
  for (const Record& r : runs) {
    seconds += r.wall_clock;
    steps += r.steps;
  }
  return {{"wall_clock_s", seconds}, {"steps", steps}};
}

ordered_json notes_json(const Plan& plan) {
  ordered_json notes = {
      {"mean_ci95", "Student's t; exact for independent draws of a normal variable, close to it for large n"},
      {"stdev_ci95", "chi-square; holds for a normal variable only, too narrow where excess_kurtosis is well above 0"},
      {"quantiles",
       "type 7 of Hyndman and Fan 1996 over the realizations done; ci95 between order statistics, free of any "
       "distribution; null is unbounded"},
      {"exceedance",
       "k of n realizations have a value > x; n includes the failed ones, p counts them as not exceeding; lo is "
       "Wilson's 95 % lower bound "
       "with no failed one exceeding, hi the upper bound with all of them exceeding"},
      {"noise_floor",
       "realization 0 and its replicates with tan(phi) scaled by 1 + 1e-6 k; a stdev near its noise_floor_stdev is "
       "numerics"}};
  if (plan.study.sampling == Sampling::latin_hypercube)
    notes["sampling"] =
        "Latin hypercube on the leading modes: the draws are not independent, so no interval here is exact; that of "
        "the mean is conservative "
        "where the measure is monotonic in the modes, since stratification lowers the variance of the mean";
  if (plan.study.stop_half_width)
    notes["stopping"] =
        "the study ends at the first realization that makes the interval of the mean narrow enough; such an interval "
        "covers slightly less than 95 %";
  return notes;
}

/// Realization 0 is itself a replicate: the one with k = 0.
std::vector<Record> with_origin(const std::vector<Record>& floor, const std::vector<Record>& runs) {
  std::vector<Record> all;
  if (!floor.empty() && !runs.empty() && runs.front().index == 0) all.push_back(runs.front());
  all.insert(all.end(), floor.begin(), floor.end());
  return all;
}

ordered_json floor_json(const Plan& plan, const std::vector<Record>& floor) {
  const auto done = std::count_if(floor.begin(), floor.end(), [](const Record& r) { return r.done; });
  return {{"replicates_planned", plan.study.noise_floor_replicates},
          {"replicates_done", done},
          {"replicates_failed", static_cast<std::int64_t>(floor.size()) - done},
          {"relative_step_of_tan_phi", 1e-6}};
}

ordered_json extremes_json(const std::vector<Record>& runs) {
  ordered_json shortest, longest;
  const Record* lo = nullptr;
  const Record* hi = nullptr;
  for (const Record& r : runs) {
    if (!r.done) continue;
    if (!lo || r.measures.influence_zone < lo->measures.influence_zone) lo = &r;
    if (!hi || r.measures.influence_zone > hi->measures.influence_zone) hi = &r;
  }
  return {{"shortest_realization", lo ? ordered_json(lo->index) : ordered_json()},
          {"farthest_realization", hi ? ordered_json(hi->index) : ordered_json()}};
}

}  // namespace

bool too_many_failed(const Plan& plan, const std::vector<Record>& runs) {
  const auto failed = std::count_if(runs.begin(), runs.end(), [](const Record& r) { return !r.done; });
  return static_cast<double>(failed) > plan.study.max_failed_share * static_cast<double>(runs.size());
}

ordered_json summarize(const Plan& plan, const std::vector<Record>& runs, const std::vector<Record>& floor) {
  const std::vector<Record> noise = with_origin(floor, runs);
  const auto done = std::find_if(runs.begin(), runs.end(), [](const Record& r) { return r.done; });
  ordered_json study = {
      {"title", plan.title},
      {"provenance",
       {{"program", "talus"},
        {"version", plan.version},
        {"seed", plan.seed},
        {"case_hash", plan.case_hash},
        {"sampling", plan.study.sampling == Sampling::latin_hypercube ? "latin_hypercube" : "monte_carlo"}}},
      {"realizations", realizations_json(plan, runs)}};
  if (plan.study.sampling == Sampling::latin_hypercube)
    study["provenance"]["stratified_modes"] = plan.study.stratified_modes;
  for (const MeasureColumn& column : measure_columns)
    study["quantities"][column.key] = quantity_json(plan, runs, noise, column);
  study["captured_variance"] = done == runs.end() ? ordered_json() : ordered_json(done->captured_variance);
  study["mean_friction_angle_deg"] = mean_phi_json(runs);
  study["noise_floor"] = floor_json(plan, floor);
  study["extremes"] = extremes_json(runs);
  study["failures"] = failures_json(runs);
  study["effort"] = effort_json(runs);
  study["notes"] = notes_json(plan);
  return study;
}

}  // namespace talus
