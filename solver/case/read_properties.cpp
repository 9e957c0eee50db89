// The keys of random_field.properties and random_field.correlation: the distribution of each property.

#include <algorithm>
#include <cmath>

#include "case/sections.hpp"
#include "math/angle.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

constexpr Names<MarginalKind> marginals[] = {{"lognormal", MarginalKind::lognormal},
                                             {"normal", MarginalKind::normal},
                                             {"beta", MarginalKind::beta},
                                             {"uniform", MarginalKind::uniform},
                                             {"constant", MarginalKind::constant}};
constexpr Names<Varies> variations[] = {{"in_space", Varies::in_space}, {"once", Varies::once}};
constexpr Names<Layers> layers[] = {{"one_field", Layers::one_field}, {"independent", Layers::independent}};

/// Properties of the soil that cannot be random.
constexpr std::string_view only_constant[] = {"residual_friction", "residual_cohesion", "pore_pressure_ratio"};

constexpr Quantity cov_range{"", 0.0, 10.0};
constexpr Quantity log_stdev_range{"", 0.0, 5.0};

/// What is said of a property, and the range of its values in the unit of property_names.
struct PropertyText {
  std::string_view words;
  double lo, hi;
  bool lo_open;
  std::string_view cov;  ///< what coefficients of variation are measured
};
constexpr std::array<PropertyText, property_count> texts{
    {{"the tangent of the friction angle", 0.0, 57.0, true, "Phoon & Kulhawy 1999: 0.05 to 0.15 of phi"},
     {"the cohesion", 0.0, 1e6, false, "Phoon & Kulhawy 1999: 0.1 to 0.55 of undrained strength"},
     {"the unit weight in place", 0.00981, 981.0, false, "Phoon & Kulhawy 1999: below 0.1"},
     {"the viscosity once the soil has yielded", 0.0, 1e9, false, "back-analyses, see talus validate"}}};

/// Reads the keys of one property.
class PropertyReader {
 public:
  PropertyReader(ObjectReader& in, PropertySpec& spec, const std::filesystem::path& directory, FieldData& data)
      : in_(in),
        spec_(spec),
        directory_(directory),
        data_(data),
        name_(name_of(spec.property)),
        text_(texts[index_of(spec.property)]) {}

  void read() {
    in_.choice("marginal", spec_.marginal, marginals,
               {"Distribution at a point. normal is truncated at low and high; constant replaces the material's value.",
                "laboratory; lognormal where nothing else is known"});
    read_value("mean", "Mean of ", spec_.mean, "the material's value; with log_stdev its median is");
    in_.optional_number(
        "cov", spec_.cov, cov_range,
        {"Coefficient of variation, standard deviation / mean, of the value at a point.", text_.cov, "none"});
    const std::string stdev = key("stdev");
    in_.optional_number(stdev, spec_.stdev, {name_.unit, 0.0, text_.hi},
                        {"Standard deviation, instead of cov.", "laboratory", "none"});
    read_logarithm();
    read_value("low", "Lower bound of ", spec_.low, "0 for normal, half the mean for a unit weight; otherwise none");
    read_value("high", "Upper bound of ", spec_.high, "none");
    in_.choice("varies", spec_.varies, variations,
               {"in_space: a field; once: one value for all of the soil in a realization."});
    in_.choice("layers", spec_.layers, layers,
               {"one_field: one field, or value, through all materials; independent: one for each material."});
    in_.string("material", spec_.material, {0, 100}, {"Name of the material that it applies to; empty: all."});
    convert();
    in_.exclude("cov", stdev);
    in_.exclude(key("mean"), key("log_mean"));
    check_form();
    data_.append(read_field_data(in_, directory_, measured()));
  }

 private:
  Measured measured() const {
    if (spec_.property == Property::friction) return measured_angles;
    return {spec_.property, "values of " + std::string(text_.words), values_, {name_.unit, 0.0, text_.hi}};
  }
  std::string key(std::string_view stem) const { return std::string(stem) + "_" + std::string(name_.suffix); }
  bool given(const std::string& key) const { return in_.find(key) != nullptr; }

  /// A value in the unit of the property; that of friction may also be an angle.
  void read_value(std::string_view stem, const std::string& is, std::optional<double>& value, std::string_view absent) {
    const std::string own = key(stem), sentence = is + std::string(text_.words) + ".";
    in_.optional_number(own, value, values_, {sentence, "laboratory", absent});
    if (spec_.property != Property::friction) return;
    const std::string in_degrees = std::string(stem) + "_deg", of_angle = "The same as the angle of that tangent.";
    std::optional<double> degrees;
    in_.optional_number(in_degrees, degrees, {"deg", 0.0, 89.0, true}, {of_angle, "laboratory", "none"});
    in_.exclude(in_degrees, own);
    if (degrees) value = std::tan(radians(*degrees));
  }

  void read_logarithm() {
    const std::string sentence = "Mean of the logarithm of the value in the unit of the key, instead of the mean.";
    in_.optional_number(key("log_mean"), spec_.log_mean, {name_.unit, -20.0, 20.0}, {sentence, "laboratory", "none"});
    in_.optional_number("log_stdev", spec_.log_stdev, log_stdev_range,
                        {"Standard deviation of the logarithm, instead of cov.", "laboratory", "none"});
  }

  void convert() {
    for (auto* value : {&spec_.mean, &spec_.stdev, &spec_.low, &spec_.high})
      if (*value) **value *= name_.factor;
    if (spec_.log_mean) *spec_.log_mean += std::log(name_.factor);
  }

  /// The keys that the distribution takes, and no others.
  void check_form() {
    const MarginalKind kind = spec_.marginal;
    const bool bounded = kind == MarginalKind::normal || kind == MarginalKind::beta || kind == MarginalKind::uniform;
    const bool by_bounds = kind == MarginalKind::uniform && (spec_.low || spec_.high);
    const bool by_logarithm = kind == MarginalKind::lognormal && (spec_.log_mean || spec_.log_stdev);
    const bool spread = kind != MarginalKind::constant && !by_bounds && !by_logarithm;
    const auto unused = [&](const std::string& key, bool stated, bool taken) {
      if (stated && !taken) in_.fault(key, "is not used by this distribution and these keys; remove it");
    };
    const auto needed = [&](const std::string& key, bool stated, bool is_needed, const Quantity& q,
                            const char* also = "") {
      if (is_needed && !stated) in_.fault(key, std::string("is missing") + also + "; " + q.describe());
    };
    unused(key("low"), spec_.low.has_value(), bounded);
    unused(key("high"), spec_.high.has_value(), bounded);
    unused(given("mean_deg") ? "mean_deg" : key("mean"), spec_.mean && !spec_.log_mean, !by_bounds && !by_logarithm);
    unused("cov", spec_.cov.has_value(), spread);
    unused(key("stdev"), spec_.stdev.has_value(), spread);
    unused(key("log_mean"), spec_.log_mean.has_value(), by_logarithm);
    unused("log_stdev", spec_.log_stdev.has_value(), by_logarithm);
    needed("cov", spec_.cov || spec_.stdev, spread, cov_range,
           kind == MarginalKind::lognormal ? " (or log_stdev)" : "");
    needed("log_stdev", spec_.log_stdev.has_value(), by_logarithm, log_stdev_range);
    needed(key("mean"), spec_.mean.has_value(), kind == MarginalKind::constant, values_);
    needed(key("low"), spec_.low.has_value(), by_bounds || kind == MarginalKind::beta, values_);
    needed(key("high"), spec_.high.has_value(), by_bounds || kind == MarginalKind::beta, values_);
  }

  ObjectReader& in_;
  PropertySpec& spec_;
  const std::filesystem::path& directory_;
  FieldData& data_;
  const PropertyName& name_;
  const PropertyText& text_;
  const Quantity values_{name_.unit, text_.lo, text_.hi, text_.lo_open};
};

void read_all(ObjectReader& in, FieldSpec& spec, const std::filesystem::path& directory, FieldData& data) {
  for (std::size_t k = 0; k < property_count; ++k) {
    const std::string_view key = property_names[k].key;
    in.object(key, "Distribution of " + std::string(texts[k].words) + ".", Absent::skip, [&](ObjectReader& section) {
      PropertySpec& property = spec.properties.emplace_back();
      property.property = static_cast<Property>(k);
      PropertyReader(section, property, directory, data).read();
    });
  }
  for (const std::string_view name : only_constant)
    if (in.find(name)) in.fault(name, "cannot be random; a material states it as a constant (softening, r_u)");
  if (in.find("undrained_strength"))
    in.fault("undrained_strength",
             "is called cohesion here: in undrained materials cohesion is the undrained strength");
  if (spec.properties.empty())
    in.fault("", "states no property; give one of friction, cohesion, unit_weight, viscosity");
}

/// Two different names of properties.
void read_pair(ObjectReader& in, PropertyCorrelation& c) {
  Json words = Json::array();
  for (const PropertyName& name : property_names) words.push_back(name.key);
  in.declare("between",
             {{"type", "array"},
              {"minItems", 2},
              {"maxItems", 2},
              {"uniqueItems", true},
              {"items", {{"type", "string"}, {"enum", words}}}},
             {"Names of the two properties."}, "", nullptr, true);
  const Json* list = in.find("between");
  if (list == nullptr) return in.fault("between", "is missing; the names of two properties");
  in.record("between", *list);
  if (!list->is_array() || list->size() != 2)
    return in.fault("between", quote(*list) + " is not a list of two properties");
  const auto place = [&](std::size_t k) { return std::ranges::find(words, (*list)[k]) - words.begin(); };
  for (std::size_t k = 0; k < 2; ++k)
    if (place(k) == std::ssize(words))
      return in.faults().add(pointer_to(in.pointer("between"), k),
                             quote((*list)[k]) + " is not one of friction, cohesion, unit_weight, viscosity");
  if ((*list)[0] == (*list)[1]) return in.fault("between", quote(*list) + " are not two different properties");
  c.a = static_cast<Property>(place(0));
  c.b = static_cast<Property>(place(1));
}

}  // namespace

void read_properties(ObjectReader& in, FieldSpec& spec, const std::filesystem::path& directory,
                     SourceLocations& origins) {
  in.object("properties",
            "The random properties of the soil. Those that are not stated are the material's. With truncation the "
            "field is scaled to its full variance at each point.",
            Absent::skip, [&](ObjectReader& section) { read_all(section, spec, directory, origins.field_data); });
  in.objects("correlation", {1, 6}, {"Correlation of pairs of properties; others are independent.", "laboratory"},
             "The correlation coefficient of two properties at a point.", [&](ObjectReader& pair) {
               PropertyCorrelation& c = spec.correlation.emplace_back();
               read_pair(pair, c);
               pair.required_number("value", c.value, {"", -1.0, 1.0, true, true},
                                    {"Correlation coefficient of the properties themselves, not of their normal "
                                     "numbers.",
                                     "laboratory; friction and cohesion -0.24 to -0.70, Cherubini 2000"});
             });
  if (in.find("correlation") == nullptr) in.remove_record("correlation");
  if (in.find("correlation") != nullptr && in.find("properties") == nullptr)
    in.fault("correlation", "needs properties");
}

}  // namespace talus
