#include "figures/study_files.hpp"

#include "study/publish.hpp"
#include "study/quality_summary.hpp"
#include "support/error.hpp"
#include "support/json.hpp"

namespace talus::figures {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_json_bytes = std::size_t{256} << 20;

std::optional<double> number_or_null(const Json& value) {
  return value.is_null() ? std::nullopt : std::optional(value.get<double>());
}

std::optional<Interval> interval_or_null(const Json& value) {
  if (value.is_null()) return std::nullopt;
  return Interval{number_or_null(value.at(0)), number_or_null(value.at(1))};
}

Quantity read_quantity(const Json& node) {
  const Json& bins = node.at("histogram");
  Quantity q{.mean = number_or_null(node.at("mean")),
             .mean_ci95 = interval_or_null(node.at("mean_ci95")),
             .stdev = number_or_null(node.at("stdev")),
             .stdev_ci95 = interval_or_null(node.at("stdev_ci95")),
             .histogram = {.edges = bins.at("edges"),
                           .counts = bins.at("counts"),
                           .underflow = bins.at("underflow"),
                           .overflow = bins.at("overflow")},
             .exceedance = {},
             .noise_floor_stdev = number_or_null(node.at("noise_floor_stdev")),
             .quantiles = {}};
  for (const Json& e : node.at("exceedance"))
    q.exceedance.push_back(
        {.x = e.at("x"), .k = e.at("k"), .n = e.at("n"), .p = e.at("p"), .lo = e.at("lo"), .hi = e.at("hi")});
  for (const Json& quantile : node.value("quantiles", Json::array()))
    q.quantiles[quantile.at("p")] = quantile.at("value");
  if (const auto censored = node.find("censored"); censored != node.end() && censored->is_object()) {
    q.censored = censored->at("runs");
    q.censored_from = censored->at("from");
  }
  return q;
}

StudyFiles read_summary(const Json& study) {
  StudyFiles files;
  files.title = study.at("title");
  const Json& from = study.at("provenance");
  files.source = "Talus " + from.at("version").get<std::string>() + "  ·  seed " + from.at("seed").dump() +
                 "  ·  case " + from.at("case_hash").get<std::string>();
  const Json& realizations = study.at("realizations");
  files.planned = realizations.at("planned");
  files.done = realizations.at("done");
  files.failed = realizations.at("failed");
  if (study.contains("quality")) files.quality = quality_line(study.at("quality"));  // version 0.1.0 does not write it
  for (const auto& [key, node] : study.at("quantities").items()) files.quantities[key] = read_quantity(node);
  for (const Json& target : study.value("targets", Json::array())) {
    const Json& of = target.at("reached");
    files.reached[target.at("name")] = {.k = of.at("k"),
                                        .n = of.at("n"),
                                        .unknown = of.at("undecided"),
                                        .p = of.at("p"),
                                        .lo = of.at("lo"),
                                        .hi = of.at("hi")};
  }
  if (!files.quantities.contains("influence_zone_m")) throw IoError("quantities.influence_zone_m is missing");
  return files;
}

}  // namespace

StudyFiles read_study(const fs::path& directory) {
  const fs::path summary = directory / "study.json";
  StudyFiles files;
  try {
    files = read_summary(read_json(summary, max_json_bytes));
  } catch (const Json::exception& e) {
    throw IoError(summary.string() + " is not a valid study summary: " + e.what());
  }
  for (const Record& r : read_csv(directory / "realizations.csv", "index"))
    if (r.done)
      files.realizations.push_back(
          {r.index, r.measures.influence_zone, r.mean_phi_deg, r.is_lower_bound(measure_table[0])});
  return files;
}

}  // namespace talus::figures
