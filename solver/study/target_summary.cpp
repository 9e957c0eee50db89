#include "study/target_summary.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "statistics/histogram.hpp"
#include "statistics/sample.hpp"
#include "study/summary.hpp"
#include "support/measures.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

constexpr double curve_points = 40.0;  // about so many along the curve

std::int64_t size_of(const TargetSample& sample) {
  return static_cast<std::int64_t>(sample.outcomes.size()) + sample.failed;
}

/// @param succeeds  whether an outcome was seen to succeed
template <class Succeeds>
Proportion count(const TargetSample& sample, const Succeeds& succeeds) {
  std::int64_t k = 0, open = 0;
  for (const TargetOutcome& outcome : sample.outcomes) {
    const bool seen = succeeds(outcome);
    k += seen ? 1 : 0;
    open += !seen && outcome.open ? 1 : 0;
  }
  return proportion(k, size_of(sample), open + sample.failed);
}

/// The number of the runs that reached the target, or that have it anyway.
std::vector<double> values_of(const TargetSample& sample, const TargetNumber& number) {
  std::vector<double> values;
  for (const TargetOutcome& outcome : sample.outcomes)
    if (const double value = outcome.*number.member; outcome.arrives && !std::isnan(value)) values.push_back(value);
  std::ranges::sort(values);
  return values;
}

Json proportion_json(const Proportion& of) {
  return {{"k", of.k}, {"n", of.n}, {"p", of.p}, {"lo", of.lo}, {"hi", of.hi}, {"undecided", of.unknown}};
}

Json curve_json(const TargetSample& sample, const TargetNumber& number) {
  Json curve = Json::array();
  const std::vector<double> values = values_of(sample, number);
  if (values.empty() || values.back() <= 0.0) return curve;
  const double first = number.optional ? values.front() : 0.0, width = (values.back() - first) / curve_points;
  for (const double x : round_grid(first, values.back(), width > 0.0 ? width : 0.1)) {
    Json point = {{"x", x}};
    point.update(proportion_json(beyond(sample, number, x)));
    curve.push_back(std::move(point));
  }
  return curve;
}

Json number_json(const TargetSample& sample, const TargetNumber& number) {
  const std::vector<double> values = values_of(sample, number);
  const SampleMoments m = moments(values);
  const auto or_null = [](const std::optional<double>& value) { return value ? Json(*value) : Json(); };
  return {{"n", m.n},
          {"mean", or_null(m.mean)},
          {"mean_ci95", m.mean_ci95 ? Json({or_null(m.mean_ci95->lo), or_null(m.mean_ci95->hi)}) : Json()},
          {"stdev", or_null(m.stdev)},
          {"min", or_null(m.min)},
          {"median", values.empty() ? Json() : Json(quantile(values, 0.5).value)},
          {"q95", values.empty() ? Json() : Json(quantile(values, 0.95).value)},
          {"max", or_null(m.max)},
          {"exceedance", curve_json(sample, number)}};
}

std::string two_digits(double p) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", p);
  return text;
}

/// "P(house reached) = 0.58, 95 % 0.48 to 0.67, 58 of 100"
Json answer(const std::string& quantity, const std::string& event, const Json& x, const char* unit,
            const Proportion& of, std::int64_t failed) {
  std::string sentence = "P(" + event + ") = " + two_digits(of.p) + ", 95 % " + two_digits(of.lo) + " to " +
                         two_digits(of.hi) + ", " + std::to_string(of.k) + " of " + std::to_string(of.n);
  if (of.unknown > 0)
    sentence += "; " + std::to_string(of.unknown) + " undecided (" + std::to_string(failed) +
                " failed) count in the upper bound";
  Json all = {{"quantity", quantity}, {"x", x}, {"unit", unit}};
  all.update(proportion_json(of));
  all["failed"] = failed;
  all["interval"] = "Wilson, 95 %";
  all["sentence"] = sentence;
  return all;
}

}  // namespace

Proportion reached(const TargetSample& sample) {
  return count(sample, [](const TargetOutcome& outcome) { return outcome.arrives; });
}

Proportion beyond(const TargetSample& sample, const TargetNumber& number, double x) {
  const bool by_time = number.optional;
  return count(sample, [&](const TargetOutcome& outcome) {
    const double value = outcome.*number.member;
    return by_time ? value <= x : value > x;
  });
}

std::optional<std::size_t> hazard_class(const TargetOutcome& outcome, const std::vector<HazardClass>& classes) {
  std::optional<std::size_t> last;
  for (std::size_t k = 0; k < classes.size(); ++k) {
    const HazardClass& one = classes[k];
    if (outcome.arrives && outcome.peak_depth >= one.depth.value_or(0.0) &&
        outcome.peak_speed >= one.speed.value_or(0.0) &&
        outcome.peak_dynamic_pressure >= one.dynamic_pressure.value_or(0.0))
      last = k;
  }
  return last;
}

Json target_json(const TargetSample& sample, const std::vector<HazardClass>& classes) {
  Json entry = {{"name", sample.of.name}, {"kind", word(sample.of.kind)}};
  entry["reached"] = proportion_json(reached(sample));
  entry["open"] = std::ranges::count_if(sample.outcomes, &TargetOutcome::open);
  for (const TargetNumber& number : target_numbers)
    if (has_number(sample.of.kind, number)) entry["numbers"][number.key] = number_json(sample, number);
  for (std::size_t k = 0; k < classes.size(); ++k) {
    const auto in_class = [&](const TargetOutcome& outcome) { return hazard_class(outcome, classes) == k; };
    const Proportion at_least = count(sample, [&](const TargetOutcome& outcome) {
      const std::optional<std::size_t> of = hazard_class(outcome, classes);
      return of && *of >= k;
    });
    entry["hazard_classes"].push_back({{"name", classes[k].name},
                                       {"runs", std::ranges::count_if(sample.outcomes, in_class)},
                                       {"at_least", proportion_json(at_least)}});
  }
  return entry;
}

std::vector<double> numbers_of_all(const TargetSample& sample, const TargetNumber& number) {
  std::vector<double> values;
  for (const TargetOutcome& outcome : sample.outcomes) {
    const double value = outcome.*number.member;
    if (!outcome.arrives || outcome.open || std::isnan(value)) return {};
    values.push_back(value);
  }
  return values;
}

std::optional<StudyQuantity> find_quantity(const std::string& name, const std::vector<TargetName>& targets) {
  if (const Measure* measure = find_measure(name)) return StudyQuantity{.measure = measure};
  for (std::size_t k = 0; k < targets.size(); ++k) {
    if (name == targets[k].name) return StudyQuantity{.target = k};
    for (const TargetNumber& number : target_numbers)
      if (has_number(targets[k].kind, number) && name == targets[k].name + "." + number.key)
        return StudyQuantity{.target = k, .number = &number};
  }
  return std::nullopt;
}

std::vector<std::string> quantity_names(const std::vector<TargetName>& targets) {
  std::vector<std::string> names;
  for (const Measure& measure : measure_table) names.emplace_back(measure.key);
  for (const TargetName& target : targets)
    for (const TargetNumber& number : target_numbers)
      if (has_number(target.kind, number)) names.push_back(target.name + "." + number.key);
  return names;
}

Json exceedance_at(const Measure& measure, const MeasureSample& sample, double x) {
  std::vector<double> values = sample.values, censored = sample.censored;
  std::ranges::sort(values);
  std::ranges::sort(censored);
  const std::vector<Exceedance> one = exceedance(values, std::span(&x, 1), sample.failed, censored);
  Proportion of;
  if (!one.empty()) {
    const Exceedance& e = one.front();
    of = {.k = e.k, .n = e.n, .unknown = sample.failed, .p = e.p, .lo = e.lo, .hi = e.hi};
  }
  Json all = answer(measure.key, std::string(measure.key) + " > " + to_text(x) + " " + measure.unit, x, measure.unit,
                    of, sample.failed);
  if (!censored.empty()) {
    all["censored"] = censored.size();
    all["sentence"] = all["sentence"].get<std::string>() + "; " + std::to_string(censored.size()) +
                      " left the terrain and count as beyond";
  }
  return all;
}

Json exceedance_at(const TargetSample& sample, const TargetNumber* number, double x) {
  const std::string& name = sample.of.name;
  if (number == nullptr) return answer(name, name + " reached", nullptr, "-", reached(sample), sample.failed);
  const std::string quantity = name + "." + number->key;
  return answer(quantity, quantity + (number->optional ? " <= " : " > ") + to_text(x) + " " + number->unit, x,
                number->unit, beyond(sample, *number, x), sample.failed);
}

}  // namespace talus
