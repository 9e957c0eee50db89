#include "figures/study_files.hpp"

#include <charconv>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "io/files.hpp"
#include "math/error.hpp"

namespace talus::figures {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

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

std::vector<std::string> fields_of(std::string_view line) {
  std::vector<std::string> fields(1);
  bool inside_quotes = false;
  for (const char c : line) {
    if (c == '"') {
      inside_quotes = !inside_quotes;
    } else if (c == ',' && !inside_quotes) {
      fields.emplace_back();
    } else if (c != '\r') {
      fields.back() += c;
    }
  }
  return fields;
}

double to_number(const std::map<std::string, std::string>& row, const char* column) {
  const auto cell = row.find(column);
  if (cell == row.end()) throw IoError(std::string("has no column ") + column);
  double value = 0.0;
  const std::string& text = cell->second;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size())
    throw IoError("column " + std::string(column) + ": \"" + text + "\" is not a number");
  return value;
}

}  // namespace

json read_json(const fs::path& path) {
  try {
    return json::parse(read_file(path, max_json_bytes));
  } catch (const json::exception& e) {
    throw IoError(path.string() + " is not JSON: " + e.what());
  }
}

std::vector<std::map<std::string, std::string>> read_table(const fs::path& path) {
  const std::string text = read_file(path, max_csv_bytes);
  std::vector<std::string> header;
  std::vector<std::map<std::string, std::string>> rows;
  int line = 0;
  for (std::size_t at = 0; at < text.size(); ++line) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::vector<std::string> fields = fields_of(std::string_view(text).substr(at, end - at));
    at = end + 1;
    if (line == 0) {
      header = fields;
      continue;
    }
    if (fields.size() != header.size()) {
      throw IoError(path.string() + ":" + std::to_string(line + 1) + ": " + std::to_string(fields.size()) +
                    " fields instead of " + std::to_string(header.size()));
    }
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
    files = read_summary(read_json(summary));
  } catch (const json::exception& e) {
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
