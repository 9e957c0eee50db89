#include "cli/progress.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

#include "study/quality_summary.hpp"
#include "support/measures.hpp"
#include "support/text.hpp"

namespace talus::cli {
namespace {

template <class... T>
std::string format(const char* pattern, T... values) {
  char text[256];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

/// "45 s", "22 min", "3.5 h", "2.1 days"
std::string duration(double seconds) {
  if (seconds < 90.0) return format("%.0f s", seconds);
  if (seconds < 90.0 * 60.0) return format("%.0f min", seconds / 60.0);
  if (seconds < 48.0 * 3600.0) return format("%.1f h", seconds / 3600.0);
  return format("%.1f days", seconds / 86400.0);
}

std::string number(const Json& value, const char* pattern = "%.3f") {
  return value.is_null() ? "-" : format(pattern, value.get<double>());
}

std::string interval(const Json& ends) {
  return ends.is_null() ? "-"
                        : std::string("[").append(number(ends[0])).append(", ").append(number(ends[1])).append("]");
}

const Json* quantile(const Json& quantity, double p) {
  for (const Json& q : quantity.at("quantiles"))
    if (q.at("p") == p) return &q;
  return nullptr;
}

/// "0-3, 7, ..." of ranges with both ends included.
std::string ranges(const Json& all) {
  constexpr std::size_t most = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, all.size()); ++i) {
    text.append(i == 0 ? "" : ", ").append(all[i][0].dump());
    if (all[i][0] != all[i][1]) text.append("-").append(all[i][1].dump());
  }
  return all.size() > most ? text + ", ..." : text;
}

/// "friction 62 % [55, 69]"
std::string share_text(const Json& of) {
  return format("%s %.0f %% [%.0f, %.0f]", of.at("name").get<std::string>().c_str(),
                100.0 * of.at("share").get<double>(), 100.0 * of.at("ci95")[0].get<double>(),
                100.0 * of.at("ci95")[1].get<double>());
}

/// What moves a measure: the share of each property, and the three strongest numbers.
std::string sensitivity_text(const std::string& key, const Json& regression) {
  std::string text = "variance of " + key + " explained by";
  for (std::size_t i = 0; i < regression.at("shares").size(); ++i)
    text += (i == 0 ? " " : ", ") + share_text(regression.at("shares")[i]);
  text += "\n";
  std::vector<Json> slopes = regression.at("slopes");
  std::ranges::stable_sort(slopes, std::greater<>(),
                           [](const Json& of) { return std::abs(of["per_stdev"].get<double>()); });
  constexpr std::size_t most = 3;
  for (std::size_t i = 0; i < std::min(most, slopes.size()); ++i)
    text += std::string(i == 0 ? "strongest coefficients, m per standard deviation: " : ", ") +
            slopes[i].at("name").get<std::string>() + format(" %+.3f ", slopes[i].at("per_stdev").get<double>()) +
            interval(slopes[i].at("ci95"));
  return text + "\n";
}

}  // namespace

std::optional<double> time_left(const Progress& p) {
  if (p.made_now == 0 || p.elapsed <= 0.0) return std::nullopt;
  const auto remaining = static_cast<double>(p.planned - p.done - p.failed + p.floor_planned - p.floor_made);
  return remaining * p.elapsed / static_cast<double>(p.made_now);
}

std::string progress_line(const Progress& p) {
  std::string text =
      std::to_string(p.done) + "/" + std::to_string(p.planned) + " done, " + std::to_string(p.failed) + " failed";
  if (p.run_again > 0) text += ", " + std::to_string(p.run_again) + " run again";
  if (p.mean) text += format(", mean farthest particle %.2f", *p.mean);
  if (p.mean_half_width) text += format(" +/- %.2f", *p.mean_half_width);
  if (p.mean) text += " m";
  if (const auto left = time_left(p)) text += ", " + duration(*left) + " left";
  text += ", " + std::to_string(p.running) + " running";
  if (!p.pending_reason.empty()) text += ", " + p.pending_reason;
  if (p.made_now > 0 && p.elapsed > 0.0) {
    const double rate = 3600.0 * static_cast<double>(p.made_now) / p.elapsed;
    text += format(rate < 10.0 ? ", %.2g/h" : ", %.0f/h", rate);
  }
  if (p.leading_mean)
    text += format("; %s: %.2f +/- %.2f m by regression", leading_measure.label, p.leading_mean->mean,
                   p.leading_mean->standard_error * p.leading_mean->student);
  return text;
}

/// The bar takes what the line leaves, and no less than 8 columns.
std::string progress_bar(const Progress& p, int width) {
  const std::string line = progress_line(p);
  const int cells = std::clamp(width - static_cast<int>(line.size()) - 3, 8, 30);
  const double share = p.planned > 0 ? static_cast<double>(p.done + p.failed) / static_cast<double>(p.planned) : 1.0;
  const auto full = static_cast<std::size_t>(std::clamp(static_cast<int>(std::floor(share * cells)), 0, cells));
  const std::string bar = std::string(full, '#') + std::string(static_cast<std::size_t>(cells) - full, '.');
  return ("[" + bar + "] " + line).substr(0, static_cast<std::size_t>(std::max(width, 0)));
}

int terminal_width() {
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

std::string study_report(const Json& study) {
  const std::string quality = study.contains("quality") ? quality_line(study.at("quality")) : "";
  return (quality.empty() ? "" : quality + "\n") + summary_table(study) + regression_text(study) +
         "\nrun-out distance [m], front of " + leading_measure.label + " (" + leading_measure.key + ")\n" +
         text_histogram(study.at("quantities").at(leading_measure.key), 80);
}

std::string summary_table(const Json& study) {
  const Json& n = study.at("realizations");
  std::string text = study.at("title").get<std::string>() + "\n";
  text += format("%lld realizations planned, %lld done, %lld failed", n.at("planned").get<long long>(),
                 n.at("done").get<long long>(), n.at("failed").get<long long>());
  if (n.at("stopped_early").get<bool>()) text += "; stopped early, the mean is known well enough";
  if (!n.at("complete").get<bool>()) text += "; not run yet: " + ranges(n.at("missing"));
  text += "\nseed " + study.at("provenance").at("seed").dump() + ", captured variance " +
          number(study.at("captured_variance"));
  const Json& phi = study.at("mean_friction_angle_deg");
  text += ", mean friction angle " + number(phi.at("mean"), "%.2f") + " deg, stdev " + number(phi.at("stdev"), "%.2f") +
          " deg\n\n";
  text += format("%-20s %9s  %-19s %8s  %-17s %8s  %8s %8s\n", "", "mean", "95 % interval", "stdev", "95 % interval",
                 "noise", "median", "q95");
  const auto at_least = [](bool lower_bound) { return std::string(lower_bound ? ">=" : ""); };
  for (const Measure* measure : reading_order()) {
    if (!study.at("quantities").contains(measure->key)) continue;  // of an earlier version
    const Json& q = study.at("quantities").at(measure->key);
    const Json* median = quantile(q, 0.5);
    const Json* high = quantile(q, 0.95);
    const auto of = [&](const Json* at) {
      return at == nullptr ? std::string("-") : at_least(at->value("at_least", false)) + number(at->at("value"));
    };
    text +=
        format("%-20s %9s  %-19s %8s  %-17s %8s  %8s %8s\n", measure->key,
               (at_least(q.value("mean_at_least", false)) + number(q.at("mean"))).c_str(),
               interval(q.at("mean_ci95")).c_str(), number(q.at("stdev")).c_str(), interval(q.at("stdev_ci95")).c_str(),
               number(q.at("noise_floor_stdev")).c_str(), of(median).c_str(), of(high).c_str());
  }
  for (const Json& target : study.value("targets", Json::array())) {
    const Json& of = target.at("reached");
    text += format("%s reached: %.2f, 95 %% %.2f to %.2f, %lld of %lld\n", target.at("name").get<std::string>().c_str(),
                   of.at("p").get<double>(), of.at("lo").get<double>(), of.at("hi").get<double>(),
                   of.at("k").get<long long>(), of.at("n").get<long long>());
  }
  const Json& runout = study.at("quantities").at(measure_table[0].key);
  if (const auto censored = runout.find("censored"); censored != runout.end() && censored->is_object())
    text +=
        format("soil left the terrain in %lld realizations, from %.2f m on: they may have gone any distance beyond\n",
               censored->at("runs").get<long long>(), censored->at("from").get<double>());
  text += "influence_zone_m: the farthest particle, the paper's influence zone\n";
  if (const auto thickness = study.find("front_thickness_m"); thickness != study.end() && thickness->is_number())
    text += "front_at_thickness_m: where the deposit is " + rounded(thickness->get<double>()) + " m thick\n";
  return text + "noise: standard deviation of the numerical noise; a stdev near it says nothing about the soil\n";
}

std::string regression_text(const Json& study) {
  const Json& leading = study.at("quantities").at(leading_measure.key);
  if (!leading.contains("regression")) return {};  // of an earlier version
  const Json& of_leading = leading.at("regression");
  if (of_leading.contains("none_because"))
    return "no mean by regression: " + of_leading.at("none_because").get<std::string>() + "\n";
  std::string text = "mean by regression on the coefficients of the random field:\n";
  for (const Measure* measure : reading_order()) {
    if (!study.at("quantities").contains(measure->key)) continue;
    const Json& of = study.at("quantities").at(measure->key).at("regression");
    if (of.contains("none_because")) continue;
    text += format("%-20s %9s  %-19s  %zu coefficients, worth %.0f plain runs\n", measure->key,
                   number(of.at("mean")).c_str(), interval(of.at("mean_ci95")).c_str(), of.at("slopes").size(),
                   of.at("worth_runs").get<double>());
  }
  return text + sensitivity_text(leading_measure.key, of_leading);
}

std::string text_histogram(const Json& quantity, int width) {
  const Json& h = quantity.at("histogram");
  const auto counts = h.at("counts").get<std::vector<std::int64_t>>();
  const auto edges = h.at("edges").get<std::vector<double>>();
  if (counts.empty()) return {};
  const std::int64_t most = std::max<std::int64_t>(1, *std::max_element(counts.begin(), counts.end()));
  const int bar = std::max(10, width - 32);
  std::string text;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const auto length =
        static_cast<std::size_t>(std::lround(static_cast<double>(counts[i]) / static_cast<double>(most) * bar));
    text += format("[%9.6g, %9.6g%c %6lld ", edges[i], edges[i + 1], i + 1 == counts.size() ? ']' : ')',
                   static_cast<long long>(counts[i]));
    text += std::string(counts[i] > 0 ? std::max<std::size_t>(length, 1) : 0, '#') + "\n";
  }
  const long long below = h.at("underflow").get<long long>(), above = h.at("overflow").get<long long>();
  if (below > 0) text += format("below the first edge: %lld\n", below);
  if (above > 0) text += format("above the last edge: %lld\n", above);
  return text;
}

}  // namespace talus::cli
