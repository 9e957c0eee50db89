#include "figures/study_files.hpp"

#include <cstdint>

#include "support/csv.hpp"
#include "support/error.hpp"
#include "support/files.hpp"
#include "support/json.hpp"
#include "support/text.hpp"

namespace talus::figures {
namespace {

namespace fs = std::filesystem;
using json = Json;

constexpr std::size_t max_json_bytes = std::size_t{256} << 20;
constexpr std::size_t max_csv_bytes = std::size_t{1} << 30;

std::optional<double> number_or_null(const json& value) {
  return value.is_null() ? std::nullopt : std::optional(value.get<double>());
}

std::optional<Interval> interval_or_null(const json& value) {
  if (value.is_null()) return std::nullopt;
  return Interval{number_or_null(value.at(0)), number_or_null(value.at(1))};
}

Histogram read_histogram(const json& node) {
  return {.edges = node.at("edges"),
          .counts = node.at("counts"),
          .underflow = node.at("underflow"),
          .overflow = node.at("overflow")};
}

Quantity read_quantity(const json& node) {
  Quantity q{.mean = number_or_null(node.at("mean")),
             .mean_ci95 = interval_or_null(node.at("mean_ci95")),
             .stdev = number_or_null(node.at("stdev")),
             .stdev_ci95 = interval_or_null(node.at("stdev_ci95")),
             .histogram = read_histogram(node.at("histogram")),
             .exceedance = {},
             .noise_floor_stdev = number_or_null(node.at("noise_floor_stdev")),
             .quantiles = {}};
  for (const json& e : node.at("exceedance")) {
    Exceedance point;
    point.x = e.at("x");
    point.k = e.at("k");
    point.n = e.at("n");
    point.p = e.at("p");
    point.lo = e.at("lo");
    point.hi = e.at("hi");
    q.exceedance.push_back(point);
  }
  for (const json& quantile : node.value("quantiles", json::array()))
    q.quantiles[quantile.at("p")] = quantile.at("value");
  return q;
}

std::string source_line(const json& study) {
  const json& from = study.at("provenance");
  return "Talus " + from.at("version").get<std::string>() + "  ·  seed " + from.at("seed").dump() + "  ·  case " +
         from.at("case_hash").get<std::string>();
}

StudyFiles read_summary(const json& study) {
  StudyFiles files;
  files.title = study.at("title");
  files.source = source_line(study);
  const json& realizations = study.at("realizations");
  files.planned = realizations.at("planned");
  files.done = realizations.at("done");
  files.failed = realizations.at("failed");
  for (const auto& [key, node] : study.at("quantities").items()) files.quantities[key] = read_quantity(node);
  if (!files.quantities.contains("influence_zone_m")) throw IoError("quantities.influence_zone_m is missing");
  return files;
}

double to_number(const std::map<std::string, std::string>& row, const char* column) {
  const auto cell = row.find(column);
  if (cell == row.end()) throw IoError(std::string("has no column ") + column);
  const std::optional<double> value = talus::to_number(cell->second);
  if (!value) throw IoError("column " + std::string(column) + ": " + in_quotes(cell->second) + " is not a number");
  return *value;
}

}  // namespace

std::vector<std::map<std::string, std::string>> read_table(const fs::path& path) {
  const std::string text = read_file(path, max_csv_bytes);
  std::vector<std::map<std::string, std::string>> rows;
  CsvRows lines(text);
  if (!lines.next()) return rows;
  const std::vector<std::string> header = lines.fields();
  while (lines.next()) {
    const std::vector<std::string>& fields = lines.fields();
    if (fields.size() != header.size())
      throw IoError(path.string() + ":" + std::to_string(lines.line()) + ": " + std::to_string(fields.size()) +
                    " fields instead of " + std::to_string(header.size()));
    auto& row = rows.emplace_back();
    for (std::size_t i = 0; i < header.size(); ++i) row[header[i]] = fields[i];
  }
  return rows;
}

StudyFiles read_study(const fs::path& directory) {
  const fs::path summary = directory / "study.json";
  const fs::path table = directory / "realizations.csv";
  StudyFiles files;
  try {
    files = read_summary(read_json(summary, max_json_bytes));
  } catch (const Json::exception& e) {
    throw IoError(summary.string() + " is not a valid study summary: " + e.what());
  }
  for (const auto& row : read_table(table)) {
    if (const auto status = row.find("status"); status == row.end() || status->second != "done") continue;
    try {
      files.realizations.push_back({static_cast<std::int64_t>(to_number(row, "index")),
                                    to_number(row, "influence_zone_m"), to_number(row, "mean_friction_angle_deg")});
    } catch (const IoError& e) {
      throw IoError(table.string() + " " + e.what());
    }
  }
  return files;
}

}  // namespace talus::figures
