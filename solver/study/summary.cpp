#include "study/summary.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "statistics/histogram.hpp"
#include "statistics/sample.hpp"

namespace talus {
namespace {

constexpr std::array<double, 9> probabilities{0.01, 0.05, 0.1, 0.25, 0.5, 0.75, 0.9, 0.95, 0.99};
constexpr double exceedance_points = 40.0;  // about so many along the curve

Json json_of(const std::optional<double>& value) { return value ? Json(*value) : Json(); }
Json json_of(const Interval& interval) { return Json::array({json_of(interval.lo), json_of(interval.hi)}); }
Json json_of(const std::optional<Interval>& interval) { return interval ? json_of(*interval) : Json(); }

Json moments_json(const SampleMoments& m) {
  return {{"n", m.n},
          {"mean", json_of(m.mean)},
          {"mean_ci95", json_of(m.mean_ci95)},
          {"stdev", json_of(m.stdev)},
          {"stdev_ci95", json_of(m.stdev_ci95)},
          {"skewness", json_of(m.skewness)},
          {"excess_kurtosis", json_of(m.excess_kurtosis)},
          {"min", json_of(m.min)},
          {"max", json_of(m.max)}};
}

/// @param known_below  from here on a value is a lower bound; unset: none is
Json quantiles_json(const std::vector<double>& sorted, std::int64_t failed, std::optional<double> known_below) {
  Json all = Json::array();
  if (sorted.empty()) return all;
  for (double p : probabilities) {
    Quantile q = quantile(sorted, p, failed);
    const auto censored = [&](double value) { return known_below && value >= *known_below; };
    if (q.ci95.hi && censored(*q.ci95.hi)) q.ci95.hi.reset();
    all.push_back({{"p", q.p},
                   {"value", q.value},
                   {"at_least", censored(q.value)},
                   {"ci95", json_of(q.ci95)},
                   {"if_failed_all_below", json_of(q.if_failed_below)},
                   {"if_failed_all_above", json_of(q.if_failed_above)}});
  }
  return all;
}

Json histogram_json(const std::vector<double>& sorted, const std::vector<double>& given) {
  const std::vector<double> edges = given.empty() ? round_edges(sorted) : given;
  const Histogram h = edges.empty() ? Histogram{} : histogram(sorted, edges);
  return {{"edges", h.edges},
          {"counts", h.counts},
          {"underflow", h.underflow},
          {"overflow", h.overflow},
          {"convention", histogram_convention},
          {"edges_given", !given.empty()}};
}

Json exceedance_json(const std::vector<double>& sorted, std::int64_t failed, const std::vector<double>& censored) {
  Json all = Json::array();
  if (sorted.empty()) return all;
  const double range = sorted.back() - sorted.front();
  const auto points = round_grid(sorted.front(), sorted.back(), range > 0.0 ? range / exceedance_points : 0.1);
  for (const Exceedance& e : exceedance(sorted, points, failed, censored))
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

bool is_hypercube(const Plan& plan) { return plan.study.sampling == Sampling::latin_hypercube; }

Json notes_json(const Plan& plan) {
  Json notes = {
      {"mean_ci95", "Student's t; exact for independent draws of a normal variable, close to it for large n"},
      {"stdev_ci95", "chi-square; holds for a normal variable only, too narrow where excess_kurtosis is well above 0"},
      {"quantiles",
       "type 7 of Hyndman and Fan 1996 over the realizations done; ci95 between order statistics, free of any "
       "distribution; null is unbounded"},
      {"exceedance",
       "k of n realizations have a value > x; n includes the failed ones, p counts them as not exceeding; lo is "
       "Wilson's 95 % lower bound "
       "with no failed one exceeding, hi the upper bound with all of them exceeding"},
      {"censored",
       "runs whose value is a lower bound, since soil left the terrain through the open end towards which the slide "
       "goes: fronts that reach that end, and the centre of mass; from: the least of them. The mean and quantiles from "
       "there on are lower bounds (at_least), and exceedance counts such runs as beyond every x, lo only as far as "
       "they were seen"},
      {"front_at_thickness_m",
       "of the realizations whose deposit is somewhere front_thickness_m thick; the others have no value, and n leaves "
       "them out"},
      {"regression",
       "the mean of linear regression on the standard normal numbers that the realizations drew, whose means are known "
       "to be 0 (control variates): their number by leave-one-out, at most one for 5 runs; HC3 and Student's t; "
       "worth_runs: plain runs that would give the same standard error. slopes: change of the quantity by one standard "
       "deviation of a number; shares: of the variance of the quantity, by property, by jackknife; of correlated "
       "properties the later one counts for what does not go with the earlier ones. Linear effects only"},
      {"noise_floor",
       "realization 0 and its replicates with tan(phi) scaled by 1 + 1e-6 k; a stdev near its noise_floor_stdev is "
       "numerics"}};
  if (!plan.targets.empty())
    notes["targets"] =
        "reached: k of n realizations reached the target; numbers: of the runs that reached it, and exceedance over "
        "all "
        "runs, where a target that is not reached has nothing; of arrival_s the probability to arrive by x. lo is "
        "Wilson's 95 % lower bound for k of n, hi the upper bound with all failed and undecided runs added to k; a run "
        "is undecided (open) whose soil still moved when it ended, so that it may yet reach the target or load it more";
  if (is_hypercube(plan))
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

/// One measure: its statistics, and how much of its spread is the numerics' own.
/// @param edges  of the histogram; empty: chosen from the data
Json quantity_json(const MeasureSample& sample, const std::vector<double>& sorted, const std::vector<double>& edges) {
  SampleMoments m = moments(sample.values);
  const SampleMoments noise = moments(sample.noise);
  std::vector<double> censored = sample.censored;
  std::sort(censored.begin(), censored.end());
  const std::optional<double> known_below = censored.empty() ? std::nullopt : std::optional(censored.front());
  if (known_below) m.mean_ci95.reset();
  const std::optional<Ratio> ratio = stdev_ratio(m, noise);
  Json quantity = moments_json(m);
  quantity["mean_at_least"] = known_below.has_value();
  quantity["censored"] = known_below ? Json{{"runs", censored.size()}, {"from", *known_below}} : Json();
  quantity["quantiles"] = quantiles_json(sorted, sample.failed, known_below);
  quantity["histogram"] = histogram_json(sorted, edges);
  quantity["exceedance"] = exceedance_json(sorted, sample.failed, censored);
  quantity["noise_floor_stdev"] = json_of(noise.stdev);
  quantity["noise_floor_stdev_ci95"] = json_of(noise.stdev_ci95);
  quantity["stdev_over_noise_floor"] = ratio ? Json(ratio->value) : Json();
  quantity["stdev_over_noise_floor_ci95"] = ratio ? json_of(ratio->ci95) : Json();
  return quantity;
}

std::vector<double> sorted(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values;
}

/// The edges that the case gives for the fronts.
std::vector<double> given_edges(const Plan& plan, const Measure& measure) {
  return measure.front ? plan.study.histogram_edges : std::vector<double>{};
}

}  // namespace

bool StudySummary::add(const Record& record) {
  if (stop_.size()) return false;
  const double zone = record.measures.influence_zone;
  stop_.add(record.index, record.influence_zone());
  if (next_ < record.index) missing_.push_back({next_, record.index - 1});
  next_ = record.index + 1;
  if (record.index == 0) origin_ = record;
  quality_.add(record);
  if (!record.done) {
    failures_.push_back({{"index", record.index}, {"reason", record.reason}});
    return true;
  }
  for (std::size_t k = 0; k < measure_table.size(); ++k) {
    const double value = record.measures.*measure_table[k].member;
    samples_[k].push_back(value);
    if (!std::isnan(value) && record.is_lower_bound(measure_table[k])) censored_[k].push_back(value);
  }
  for (std::size_t k = 0; k < targets_.size(); ++k)
    if (k < record.targets.size() && record.targets[k].of.name == plan_.targets[k].name)
      targets_[k].push_back(record.targets[k]);
  indices_.push_back(record.index);
  phi_.push_back(record.mean_phi_deg);
  wall_clock_ += record.wall_clock;
  steps_ += record.steps;
  if (!front_thickness_ && !std::isnan(record.front_thickness)) front_thickness_ = record.front_thickness;
  if (!captured_variance_) captured_variance_ = record.captured_variance;
  if (!shortest_ || zone < shortest_->second) shortest_ = {record.index, zone};
  if (!farthest_ || zone > farthest_->second) farthest_ = {record.index, zone};
  return true;
}

MeasureSample StudySummary::sample(const Measure& measure) const {
  std::vector<double> noise;
  const auto add = [&](const Record& r) {
    if (r.done && !std::isnan(r.measures.*measure.member)) noise.push_back(r.measures.*measure.member);
  };
  if (origin_ && !replicates_.empty()) add(*origin_);
  std::for_each(replicates_.begin(), replicates_.end(), add);
  const auto k = static_cast<std::size_t>(&measure - measure_table.data());
  MeasureSample sample{.values = {},
                       .censored = censored_[k],
                       .noise = std::move(noise),
                       .failed = failed(),
                       .quality = quality_.counts(),
                       .complete = missing_.empty() && next_ >= until()};
  for (std::size_t i = 0; i < indices_.size(); ++i) {
    if (std::isnan(samples_[k][i])) continue;
    sample.values.push_back(samples_[k][i]);
    sample.realizations.push_back(indices_[i]);
  }
  return sample;
}

RegressionSummary regress(const Plan& plan, const MeasureSample& sample) {
  return regress(plan, sample.realizations, sample.values, !sample.censored.empty());
}

RegressionSummary StudySummary::regression(const Measure& measure) const { return regress(plan_, sample(measure)); }

TargetSample StudySummary::target_sample(std::size_t target) const {
  const bool all = targets_[target].size() == indices_.size();
  return {.of = plan_.targets[target],
          .outcomes = targets_[target],
          .failed = failed(),
          .realizations = all ? indices_ : std::vector<std::int64_t>{}};
}

Json StudySummary::target_entry(std::size_t target) const {
  const TargetSample of = target_sample(target);
  Json entry = target_json(of, plan_.study.hazard_classes);
  for (const TargetNumber& number : target_numbers) {
    const std::vector<double> values = numbers_of_all(of, number);
    if (!has_number(of.of.kind, number) || values.empty() || of.realizations.empty()) continue;
    const RegressionSummary regression = regress(plan_, of.realizations, values, false);
    if (regression.done()) entry["numbers"][number.key]["regression"] = regression_json(plan_, regression);
  }
  return entry;
}

Json StudySummary::realizations_json() const {
  Json missing = missing_;
  if (next_ < until()) missing.push_back({next_, until() - 1});
  return {{"planned", plan_.study.realizations},
          {"done", done()},
          {"failed", failed()},
          {"complete", missing.empty()},
          {"stopped_early", stopped_early()},
          {"missing", missing},
          {"max_failed_share", plan_.study.max_failed_share},
          {"stop_when_ci_half_width_below_m", json_of(plan_.study.stop_half_width)}};
}

Json StudySummary::mean_phi_json() const {
  Json all = moments_json(moments(phi_));
  all["correlation_with_influence_zone"] = json_of(correlation(phi_, samples_[0]));
  return all;
}

std::int64_t StudySummary::replicates_failed() const { return std::ranges::count(replicates_, false, &Record::done); }

Json StudySummary::replicates_json() const {
  return {{"replicates_planned", plan_.study.noise_floor_replicates},
          {"replicates_done", static_cast<std::int64_t>(replicates_.size()) - replicates_failed()},
          {"replicates_failed", replicates_failed()},
          {"relative_step_of_tan_phi", 1e-6}};
}

Json StudySummary::quality_json() const {
  const MeasureSample runout = sample(measure_table[0]);
  return quality_.json(moments(runout.values), moments(runout.noise));
}

Json StudySummary::json() const {
  Json study = {{"title", plan_.title},
                {"provenance",
                 {{"program", "talus"},
                  {"version", plan_.version},
                  {"seed", plan_.seed},
                  {"case_hash", plan_.of.hash},
                  {"sampling", is_hypercube(plan_) ? "latin_hypercube" : "monte_carlo"}}},
                {"realizations", realizations_json()},
                {"quality", quality_json()}};
  if (is_hypercube(plan_)) study["provenance"]["stratified_modes"] = plan_.study.stratified_modes;
  study["leading_quantity"] = leading_measure.key;
  for (const Measure* measure : reading_order()) {
    const MeasureSample of = sample(*measure);
    Json& quantity = study["quantities"][measure->key];
    quantity = quantity_json(of, sorted(of.values), given_edges(plan_, *measure));
    quantity["regression"] = regression_json(plan_, regress(plan_, of));
  }
  for (std::size_t k = 0; k < targets_.size(); ++k) study["targets"].push_back(target_entry(k));
  study["front_thickness_m"] = json_of(front_thickness_);
  study["captured_variance"] = json_of(captured_variance_);
  study["mean_friction_angle_deg"] = mean_phi_json();
  study["noise_floor"] = replicates_json();
  study["extremes"] = {{"shortest_realization", shortest_ ? Json(shortest_->first) : Json()},
                       {"farthest_realization", farthest_ ? Json(farthest_->first) : Json()}};
  study["failures"] = failures_;
  study["effort"] = {{"wall_clock_s", wall_clock_}, {"steps", steps_}};
  study["notes"] = notes_json(plan_);
  return study;
}

StudySummary summary_of(const Plan& plan, const std::vector<Record>& runs, const std::vector<Record>& floor) {
  StudySummary summary(plan);
  for (const Record& r : runs) summary.add(r);
  for (const Record& r : floor) summary.add_replicate(r);
  return summary;
}

Json distribution(const Plan& plan, const Measure& measure, const MeasureSample& sample, const Bins& bins) {
  const std::vector<double> values = sorted(sample.values);
  std::vector<double> edges = bins.count > 0 ? equal_edges(values, bins.count) : bins.edges;
  if (edges.empty()) edges = given_edges(plan, measure);
  Json quantity = quantity_json(sample, values, edges);
  if (bins.count > 0) quantity["histogram"]["edges_given"] = false;
  Json answer = {{"quantity", measure.key}, {"planned", plan.study.realizations}, {"done", values.size()},
                 {"failed", sample.failed}, {"quality", sample.quality.json()},   {"complete", sample.complete}};
  if (!sample.realizations.empty()) answer["regression"] = regression_json(plan, regress(plan, sample));
  for (const char* key : {"n", "mean", "mean_at_least", "mean_ci95", "censored", "stdev", "min", "max",
                          "noise_floor_stdev", "stdev_over_noise_floor", "histogram"})
    answer[key] = std::move(quantity[key]);
  return answer;
}

}  // namespace talus
