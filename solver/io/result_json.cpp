#include "io/result_json.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include "math/angle.hpp"
#include "random_field/property_spec.hpp"
#include "support/error.hpp"
#include "support/json.hpp"

namespace talus {
namespace {

constexpr const char* ending_names[] = {"end_time", "at_rest", "interrupted"};
constexpr double unbounded = -std::numeric_limits<double>::infinity();

enum class Direction { write, read };

/// One object of the document. A member is declared by the one call that writes it from its variable, or reads it into
/// that.
class ObjectIo {
 public:
  ObjectIo(Json& node, Direction direction, std::string file, std::string pointer)
      : node_(node), reading_(direction == Direction::read), file_(std::move(file)), pointer_(std::move(pointer)) {
    if (!reading_) node_ = Json::object();
    if (!node_.is_object())
      throw IoError(file_ + ": " + (pointer_.empty() ? "the document" : pointer_) + " is not an object");
  }

  /// To be done with before this object gets another member, which may move it.
  ObjectIo object(const char* key) {
    return {member(key), reading_ ? Direction::read : Direction::write, file_, pointer_ + "/" + key};
  }
  /// For an object that earlier versions did not write.
  template <class Transfer>
  void object_or_skip(const char* key, Transfer&& transfer) {
    if (!reading_ || node_.contains(key)) transfer(object(key));
  }
  void number(const char* key, double& value, double least = unbounded) {
    transfer(key, value, &Json::is_number, "a number", least);
    if (reading_ && value < least) fail(key, "a number", least);
    if (!std::isfinite(value)) throw std::domain_error("result: " + pointer_ + "/" + key + " is not a finite number");
  }
  template <std::integral T>
  void integer(const char* key, T& value, T least = 0) {
    transfer(key, value, &Json::is_number_integer, "an integer", static_cast<double>(least));
    const Json& v = member(key);
    // A number that JSON gives as unsigned may be too large for the signed type.
    const bool fits =
        v.is_number_unsigned() ? std::in_range<T>(v.get<std::uint64_t>()) : std::in_range<T>(v.get<std::int64_t>());
    if (!fits || value < least) fail(key, "an integer in range", static_cast<double>(least));
  }
  void boolean(const char* key, bool& value) { transfer(key, value, &Json::is_boolean, "true or false"); }
  void text(const char* key, std::string& value) { transfer(key, value, &Json::is_string, "a text"); }
  /// NaN where an earlier version did not write the key.
  void number_or_nan(const char* key, double& value) {
    if (has(key))
      number(key, value);
    else
      value = std::numeric_limits<double>::quiet_NaN();
  }
  /// NaN is null, or a key that an earlier version did not write.
  void number_or_null(const char* key, double& value) {
    if (reading_ ? has(key) && !member(key).is_null() : !std::isnan(value))
      number(key, value);
    else if (reading_)
      value = std::numeric_limits<double>::quiet_NaN();
    else
      member(key) = nullptr;
  }
  bool writing() const { return !reading_; }
  /// Whether a key is to be transferred that earlier versions did not write.
  bool has(const char* key) const { return !reading_ || node_.contains(key); }
  /// For a key that earlier versions did not write; empty without it.
  void text_or_empty(const char* key, std::string& value) {
    if (has(key))
      text(key, value);
    else
      value.clear();
  }
  void digest(const char* key, std::string& digits) {
    text(key, digits);
    if (reading_ && (digits.size() != 16 || digits.find_first_not_of("0123456789abcdef") != std::string::npos))
      fail(key, "16 hexadecimal digits");
  }
  void ending(const char* key, Ending& value) {
    std::string name = ending_names[static_cast<int>(value)];
    text(key, name);
    const auto* const found = std::ranges::find(ending_names, name);
    if (found == std::end(ending_names)) fail(key, "end_time, at_rest or interrupted");
    value = static_cast<Ending>(found - ending_names);
  }
  void target_kind(const char* key, TargetKind& value) {
    std::string name = word(value);
    text(key, name);
    const auto* const found = std::ranges::find(target_kind_words, name);
    if (found == target_kind_words.end()) fail(key, "point, stretch or structure");
    value = static_cast<TargetKind>(found - target_kind_words.begin());
  }
  /// Whether a list is to be transferred that is written only where it is not empty.
  bool has_list(const char* key, bool empty) const { return reading_ ? node_.contains(key) : !empty; }
  void verdict(const char* key, Verdict& value) {
    std::string name = word(value);
    text(key, name);
    const std::optional<Verdict> known = verdict_of(name);
    if (!known) fail(key, "sound, doubtful, invalid or not_assessed");
    value = *known;
  }
  /// A list of objects; each(object, element) transfers one.
  template <class T, class Each>
  void list(const char* key, std::vector<T>& elements, const Each& each) {
    Json& all = member(key);
    if (!reading_) all = Json(Json::array_t(elements.size()));
    if (!all.is_array()) fail(key, "a list");
    elements.resize(all.size());
    for (std::size_t k = 0; k < elements.size(); ++k)
      each(ObjectIo(all[k], reading_ ? Direction::read : Direction::write, file_,
                    pointer_ + "/" + key + "/" + std::to_string(k)),
           elements[k]);
  }
  /// For a list that earlier versions did not write; empty without it.
  void texts_or_none(const char* key, std::vector<std::string>& texts) {
    texts.resize(reading_ && node_.contains(key) ? member(key).size() : texts.size());
    if (!has(key)) return;
    Json& all = member(key);
    if (!reading_) all = Json(texts);
    if (!all.is_array()) fail(key, "a list");
    for (std::size_t k = 0; k < texts.size(); ++k) {
      if (!all[k].is_string()) fail(key, "a list of texts");
      texts[k] = all[k].get<std::string>();
    }
  }
  void optional(const char* key, std::optional<double>& value) {
    or_null(key, value, [&](double& x) { number(key, x); });
  }
  void optional(const char* key, std::optional<std::int64_t>& value) {
    or_null(key, value, [&](std::int64_t& n) { integer(key, n); });
  }

 private:
  template <class T>
  void transfer(const char* key, T& value, bool (Json::*of_kind)() const noexcept, const char* wanted,
                double least = unbounded) {
    Json& v = member(key);
    if (!reading_)
      v = value;
    else if (!(v.*of_kind)())
      fail(key, wanted, least);
    else
      value = v.get<T>();
  }
  template <class T, class Use>
  void or_null(const char* key, std::optional<T>& value, Use&& use) {
    if (reading_ ? !member(key).is_null() : value.has_value())
      use(value ? *value : value.emplace());
    else
      member(key) = nullptr;
  }
  Json& member(const char* key) {
    if (reading_ && !node_.contains(key)) throw IoError(file_ + ": " + pointer_ + "/" + key + " is missing");
    return node_[key];
  }
  [[noreturn]] void fail(const char* key, const std::string& wanted, double least = unbounded) {
    const std::string range = std::isfinite(least) ? " >= " + std::to_string(static_cast<long long>(least)) : "";
    throw IoError(file_ + ": " + pointer_ + "/" + key + " = " +
                  member(key).dump(-1, ' ', true, Json::error_handler_t::replace) + " is not " + wanted + range);
  }

  Json& node_;
  bool reading_;
  std::string file_;
  std::string pointer_;
};

void transfer_reason(ObjectIo node, QualityReason& reason) {
  node.text("check", reason.check);
  node.verdict("verdict", reason.verdict);
  node.number("value", reason.value);
  node.number("limit", reason.limit);
  node.text("message", reason.message);
}

void transfer_warning(ObjectIo node, Fault& warning) {
  node.text("pointer", warning.pointer);
  node.text("message", warning.message);
}

/// Results of version 0.1.0 have neither quality nor warnings.
void transfer_quality(ObjectIo& root, RunResult& result) {
  if (root.has("quality")) {
    ObjectIo quality = root.object("quality");
    quality.verdict("verdict", result.quality.verdict);
    quality.list("reasons", result.quality.reasons, transfer_reason);
  }
  if (root.has("warnings")) root.list("warnings", result.warnings, transfer_warning);
}

/// What follows from the terms is written for readers.
void transfer_energy(ObjectIo energy, EnergyBudget& budget) {
  for (const EnergyTerm& term : energy_terms) energy.number(term.key, budget.*term.value);
  double created = budget.created();
  std::optional<double> created_share = budget.created_share(), numerical_share = budget.numerical_share();
  energy.number("created_J_m", created);
  energy.optional("created_share", created_share);
  if (energy.has("numerical_share")) energy.optional("numerical_share", numerical_share);
}

/// "mean_kPa" of the cohesion.
std::string key_of(const char* stem, const PropertyName& of) {
  return std::string(stem) + "_" + std::string(of.suffix);
}

void transfer_property(ObjectIo node, const PropertyName& of, PropertySummary& property) {
  property.name = of.key;
  node.number(key_of("mean", of).c_str(), property.mean, 0.0);
  node.number("cov", property.cov, 0.0);
  node.number(key_of("run_mean", of).c_str(), property.run_mean, 0.0);
  node.number("run_cov", property.run_cov, 0.0);
}

/// Written where the case states properties.
void transfer_properties(ObjectIo node, std::vector<PropertySummary>& properties) {
  std::vector<PropertySummary> all;
  for (const PropertyName& of : property_names) {
    const std::string key(of.key);
    const auto known = std::ranges::find(properties, key, &PropertySummary::name);
    if (node.writing() ? known == properties.end() : !node.has(key.c_str())) continue;
    PropertySummary& property = all.emplace_back();
    if (node.writing()) property = *known;
    transfer_property(node.object(key.c_str()), of, property);
  }
  properties = std::move(all);
}

void transfer_measures(ObjectIo& root, RunResult& result) {
  for (const Measure* measure : reading_order()) {
    double& value = result.measures.*measure->member;
    if (measure == measure_table.data())
      root.number(measure->key, value);
    else if (measure->optional)
      root.number_or_null(measure->key, value);
    else
      root.number_or_nan(measure->key, value);
  }
  if (root.has("front_thickness_m")) root.number("front_thickness_m", result.front_thickness, 0.0);
  root.texts_or_none("notes", result.notes);
}

/// Only runs with targets have any.
void transfer_target(ObjectIo node, TargetOutcome& target) {
  node.text("name", target.of.name);
  node.target_kind("kind", target.of.kind);
  node.boolean(arrives_key, target.arrives);
  node.boolean(open_key, target.open);
  for (const TargetNumber& number : target_numbers) {
    if (!has_number(target.of.kind, number)) continue;
    if (number.optional)
      node.number_or_null(number.key, target.*number.member);
    else
      node.number(number.key, target.*number.member);
  }
}

/// Every member of the document, in its order.
void transfer_all(ObjectIo root, RunResult& result, Provenance& from) {
  transfer_measures(root, result);
  ObjectIo particles = root.object("particles");
  particles.integer("soil", result.soil);
  particles.integer("wall", result.wall);
  root.integer("steps", result.steps);
  root.number("time_s", result.time, 0.0);
  root.integer("evaluations", result.evaluations);
  root.number("wall_clock_s", result.wall_clock, 0.0);
  root.integer("threads", result.threads, 1);
  root.number("max_speed_m_s", result.max_speed, 0.0);
  root.number("final_max_speed_m_s", result.final_max_speed, 0.0);
  root.integer("penetrated", result.penetrated);
  root.integer("left_domain", result.left_domain);
  root.texts_or_none("lower_bounds", result.lower_bounds);
  root.boolean("at_rest", result.at_rest);
  root.object_or_skip("mass_kg_m", [&](ObjectIo mass) {
    mass.number("filled", result.mass.filled, 0.0);
    mass.number("outline", result.mass.outline, 0.0);
  });
  root.ending("ending", result.ending);
  root.text_or_empty("backend", result.backend);
  root.text_or_empty("simd", result.simd);
  root.digest("digest", result.digest);
  transfer_quality(root, result);
  if (root.has_list("targets", result.targets.empty())) root.list("targets", result.targets, transfer_target);

  ObjectIo field = root.object("field");
  double mean_phi_deg = degrees(result.field.mean_phi);
  field.number("captured_variance", result.field.captured_variance, 0.0);
  if (field.has("cov_tan_phi")) field.number("cov_tan_phi", result.field.cov, 0.0);
  field.number("mean_friction_angle_deg", mean_phi_deg, 0.0);
  field.integer("terms", result.field.terms);
  result.field.mean_phi = radians(mean_phi_deg);
  if (root.writing() ? !result.field.properties.empty() : field.has("properties"))
    transfer_properties(field.object("properties"), result.field.properties);
  if (root.has("energy")) transfer_energy(root.object("energy"), result.energy);

  ObjectIo provenance = root.object("provenance");
  provenance.text("version", from.version);
  provenance.integer("seed", from.seed);
  provenance.optional("realization", from.realization);
  provenance.optional("perturbation", from.perturbation);
  provenance.text("case_hash", from.case_hash);
  provenance.text("case_title", from.case_title);
  provenance.text("compiler", from.compiler);
  provenance.text("started_utc", from.started_utc);
}

}  // namespace

Json result_json(RunResult result, Provenance provenance) {
  Json document;
  transfer_all({document, Direction::write, "", ""}, result, provenance);
  return document;
}

std::pair<RunResult, Provenance> read_result(const std::filesystem::path& path) {
  constexpr std::size_t max_bytes = std::size_t{1} << 20;
  Json document = read_json(path, max_bytes);
  std::pair<RunResult, Provenance> all;
  transfer_all({document, Direction::read, path.string(), ""}, all.first, all.second);
  return all;
}

}  // namespace talus
