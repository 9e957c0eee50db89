#include "io/result_json.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include "math/angle.hpp"
#include "support/error.hpp"
#include "support/files.hpp"
#include "support/json.hpp"

namespace talus {
namespace {

namespace fs = std::filesystem;
using ordered_json = Json;

constexpr const char* ending_names[] = {"end_time", "at_rest", "interrupted"};

void refuse_not_finite(const ordered_json& node, const std::string& pointer) {
  if (node.is_number_float() && !std::isfinite(node.get<double>()))
    throw std::domain_error("result: " + pointer + " is not a finite number");
  if (node.is_object())
    for (const auto& [key, value] : node.items()) refuse_not_finite(value, pointer + "/" + key);
}

template <class T>
ordered_json or_null(const std::optional<T>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

/// One object of the document, read key by key.
class Reader {
 public:
  Reader(const Json& node, std::string file, std::string pointer)
      : node_(node), file_(std::move(file)), pointer_(std::move(pointer)) {
    if (!node_.is_object())
      throw IoError(file_ + ": " + (pointer_.empty() ? "the document" : pointer_) + " is not an object");
  }

  Reader object(const char* key) const { return {value(key), file_, pointer_ + "/" + key}; }
  double number(const char* key, double least = -std::numeric_limits<double>::infinity()) const {
    const Json& v = value(key);
    if (!v.is_number() || v.get<double>() < least) fail(key, "a number", least);
    return v.get<double>();
  }
  template <class T = std::int64_t>
  T integer(const char* key, T least = 0) const {
    const Json& v = value(key);
    if (!v.is_number_integer()) fail(key, "an integer", static_cast<double>(least));
    // A number that JSON gives as unsigned may be too large for the signed type.
    const bool fits =
        v.is_number_unsigned() ? std::in_range<T>(v.get<std::uint64_t>()) : std::in_range<T>(v.get<std::int64_t>());
    if (!fits || v.get<T>() < least) fail(key, "an integer in range", static_cast<double>(least));
    return v.get<T>();
  }
  bool boolean(const char* key) const {
    if (!value(key).is_boolean()) fail(key, "true or false");
    return value(key).get<bool>();
  }
  std::string text(const char* key) const {
    if (!value(key).is_string()) fail(key, "a text");
    return value(key).get<std::string>();
  }
  /// For keys that earlier versions did not write.
  std::string text_or_empty(const char* key) const { return node_.contains(key) ? text(key) : std::string(); }
  std::string digest(const char* key) const {
    const std::string digits = text(key);
    if (digits.size() != 16 || digits.find_first_not_of("0123456789abcdef") != std::string::npos)
      fail(key, "16 hexadecimal digits");
    return digits;
  }
  Ending ending(const char* key) const {
    const std::string name = text(key);
    for (int i = 0; i < 3; ++i)
      if (name == ending_names[i]) return static_cast<Ending>(i);
    fail(key, "end_time, at_rest or interrupted");
  }
  std::optional<std::int64_t> integer_or_null(const char* key) const {
    return value(key).is_null() ? std::nullopt : std::optional(integer(key));
  }
  std::optional<double> number_or_null(const char* key) const {
    return value(key).is_null() ? std::nullopt : std::optional(number(key));
  }

 private:
  const Json& value(const char* key) const {
    const auto found = node_.find(key);
    if (found == node_.end()) throw IoError(file_ + ": " + pointer_ + "/" + key + " is missing");
    return *found;
  }
  [[noreturn]] void fail(const char* key, const std::string& wanted,
                         double least = -std::numeric_limits<double>::infinity()) const {
    const std::string range = std::isfinite(least) ? " >= " + std::to_string(static_cast<long long>(least)) : "";
    throw IoError(file_ + ": " + pointer_ + "/" + key + " = " +
                  value(key).dump(-1, ' ', true, Json::error_handler_t::replace) + " is not " + wanted + range);
  }

  const Json& node_;
  std::string file_;
  std::string pointer_;
};

RunResult read_run(const Reader& root) {
  const Reader particles = root.object("particles");
  const Reader field = root.object("field");
  Measures measures;
  for (const Measure& measure : measure_table) measures.*measure.member = root.number(measure.key);
  return {.measures = measures,
          .ending = root.ending("ending"),
          .soil = particles.integer("soil"),
          .wall = particles.integer("wall"),
          .steps = root.integer("steps"),
          .time = root.number("time_s", 0.0),
          .evaluations = root.integer("evaluations"),
          .wall_clock = root.number("wall_clock_s", 0.0),
          .threads = root.integer<int>("threads", 1),
          .max_speed = root.number("max_speed_m_s", 0.0),
          .final_max_speed = root.number("final_max_speed_m_s", 0.0),
          .penetrated = root.integer("penetrated"),
          .left_domain = root.integer("left_domain"),
          .at_rest = root.boolean("at_rest"),
          .digest = root.digest("digest"),
          .backend = root.text_or_empty("backend"),
          .simd = root.text_or_empty("simd"),
          .field = {.captured_variance = field.number("captured_variance", 0.0),
                    .mean_phi = radians(field.number("mean_friction_angle_deg", 0.0)),
                    .terms = field.integer("terms")}};
}

Provenance read_provenance(const Reader& node) {
  return {.version = node.text("version"),
          .seed = node.integer<std::uint64_t>("seed"),
          .realization = node.integer_or_null("realization"),
          .perturbation = node.number_or_null("perturbation"),
          .case_hash = node.text("case_hash"),
          .case_title = node.text("case_title"),
          .compiler = node.text("compiler"),
          .started_utc = node.text("started_utc")};
}

}  // namespace

ordered_json result_json(const RunResult& result, const Provenance& provenance) {
  ordered_json document;
  for (const Measure& measure : measure_table) document[measure.key] = result.measures.*measure.member;
  document.update({
      {"particles", {{"soil", result.soil}, {"wall", result.wall}}},
      {"steps", result.steps},
      {"time_s", result.time},
      {"evaluations", result.evaluations},
      {"wall_clock_s", result.wall_clock},
      {"threads", result.threads},
      {"max_speed_m_s", result.max_speed},
      {"final_max_speed_m_s", result.final_max_speed},
      {"penetrated", result.penetrated},
      {"left_domain", result.left_domain},
      {"at_rest", result.at_rest},
      {"ending", ending_names[static_cast<int>(result.ending)]},
      {"backend", result.backend},
      {"simd", result.simd},
      {"digest", result.digest},
      {"field",
       {{"captured_variance", result.field.captured_variance},
        {"mean_friction_angle_deg", degrees(result.field.mean_phi)},
        {"terms", result.field.terms}}},
      {"provenance",
       {{"version", provenance.version},
        {"seed", provenance.seed},
        {"realization", or_null(provenance.realization)},
        {"perturbation", or_null(provenance.perturbation)},
        {"case_hash", provenance.case_hash},
        {"case_title", provenance.case_title},
        {"compiler", provenance.compiler},
        {"started_utc", provenance.started_utc}}},
  });
  refuse_not_finite(document, "");
  return document;
}

std::pair<RunResult, Provenance> read_result(const fs::path& path) {
  constexpr std::size_t max_bytes = std::size_t{1} << 20;
  const Json document = read_json(path, max_bytes);
  const Reader root(document, path.string(), "");
  return {read_run(root), read_provenance(root.object("provenance"))};
}

}  // namespace talus
