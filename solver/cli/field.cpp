// talus field: the random field of one realization, as numbers or as a picture, without running it.

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <iostream>
#include <memory>
#include <numeric>
#include <set>

#include "case/load.hpp"
#include "cli/help.hpp"
#include "cli/verbs.hpp"
#include "cli/xi_file.hpp"
#include "figures/profile.hpp"
#include "io/vtkhdf.hpp"
#include "math/angle.hpp"
#include "random_field/property_spec.hpp"
#include "run/realization.hpp"
#include "support/json.hpp"
#include "support/seed.hpp"

namespace talus::cli {
namespace {

namespace fs = std::filesystem;

struct FieldOptions {
  fs::path case_file, xi_file, out;
  std::vector<std::string> overrides;
  std::optional<std::int64_t> realization;
  std::optional<std::uint64_t> seed;
  bool spread = false;
  std::string property = "friction";  ///< key of property_names
  bool json = false;
};

/// A column of the output: "cohesion_kPa".
struct Column {
  std::string name;
  std::vector<double> values;
};

/// The field on the particles before they move.
struct FieldOnParticles {
  std::vector<Vec2> position;   ///< [m]
  std::vector<double> phi_deg;  ///< [deg]
  std::vector<Column> others;   ///< the random properties besides friction, in the unit of their names
  Strength strength;
  std::optional<FieldSpread> spread;  ///< median and standard deviation over realizations, where they are asked for
};

/// The place of a property in property_names by its key, which is known.
Property property_of(const std::string& key) {
  return static_cast<Property>(std::ranges::find(property_names, key, &PropertyName::key) - property_names.begin());
}

/// What is shown of a property: an angle of friction, else its value in the unit of property_names.
std::vector<double> shown(const Strength& strength, const ParticlePlan& plan, Property property) {
  std::vector<double> values = property_values(strength, plan, property);
  for (double& value : values)
    value = property == Property::friction ? friction_angle_deg(value) : value / name_of(property).factor;
  return values;
}

FieldOnParticles field_on(const Case& problem, const RunIdentity& identity, bool spread) {
  const ParticlePlan plan = plan_particles(problem.model);
  FieldOnParticles field{.position = {},
                         .phi_deg = {},
                         .others = {},
                         .strength = strength(problem.model, problem.field, problem.study, plan, identity),
                         .spread = {}};
  for (const SoilPoint& point : plan.soil) field.position.push_back(point.x);
  field.phi_deg = shown(field.strength, plan, Property::friction);
  for (const PropertySummary& summary : field.strength.summary.properties) {
    const Property property = property_of(summary.name);
    if (property != Property::friction)
      field.others.push_back(
          {summary.name + "_" + std::string(name_of(property).suffix), shown(field.strength, plan, property)});
  }
  if (spread) field.spread = field_spread(problem.model, problem.field.value(), plan);
  return field;
}

/// Puts the coefficients of the file in place of drawn ones, and checks their number where the message can name the
/// file.
void use_xi(Case& problem, const fs::path& file) {
  if (!problem.field)
    throw ConfigError("/random_field",
                      "is missing: the case has no random field that --xi could be the coefficients of");
  problem.field->xi.clear();
  const std::vector<double> xi = read_xi(file);
  const auto terms =
      static_cast<std::size_t>(field_summary(problem.model, *problem.field, plan_particles(problem.model)).terms);
  if (xi.size() != terms) {
    const std::string advice = " (--set random_field.terms=" + std::to_string(xi.size()) + " would make it fit)";
    throw ConfigError(file.string(), "holds " + std::to_string(xi.size()) + " coefficients, the field takes " +
                                         std::to_string(terms) + (problem.field->properties.empty() ? advice : ""));
  }
  problem.field->xi = xi;
}

Json extent_of(const std::vector<double>& values) {
  const auto [lo, hi] = std::ranges::minmax(values);
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  return {{"mean", sum / static_cast<double>(values.size())}, {"min", lo}, {"max", hi}};
}

Json summary(const FieldOnParticles& field, const RunIdentity& identity) {
  const auto [lo, hi] = std::minmax_element(field.phi_deg.begin(), field.phi_deg.end());
  const FieldSummary& of = field.strength.summary;
  Json out = {{"particles", field.position.size()},
              {"captured_variance", of.captured_variance},
              {"cov_tan_phi", of.cov},
              {"terms", of.terms},
              {"friction_angle_deg", {{"mean", degrees(of.mean_phi)}, {"min", *lo}, {"max", *hi}}},
              {"realization", identity.realization ? Json(*identity.realization) : Json()},
              {"seed", identity.realization ? Json(identity.seed) : Json()},
              {"xi", field.strength.xi}};
  for (const Column& column : field.others) out[column.name] = extent_of(column.values);
  return out;
}

/// What the picture shows: name, unit and figure.
struct Shown {
  const char* name;
  const char* unit;
  figures::Colour colour;
};
constexpr Shown shown_properties[] = {{"Friction angle", "°", figures::Colour::friction_angle},
                                      {"Cohesion", " kPa", figures::Colour::cohesion},
                                      {"Unit weight", " kN/m3", figures::Colour::unit_weight},
                                      {"Viscosity", " Pa s", figures::Colour::viscosity}};

/// Of the property that the options name.
const std::vector<double>& values_shown(const FieldOnParticles& field, const FieldOptions& options) {
  const std::string prefix = options.property + "_";
  const auto column = std::ranges::find_if(field.others, [&](const Column& c) { return c.name.starts_with(prefix); });
  return column == field.others.end() ? field.phi_deg : column->values;
}

std::string subtitle(const FieldOnParticles& on_particles, const FieldOptions& options) {
  const FieldSummary& field = on_particles.strength.summary;
  const Shown& what = shown_properties[index_of(property_of(options.property))];
  std::string text = std::string(what.name) + ", ";
  text += options.realization       ? "realization " + std::to_string(*options.realization)
          : options.xi_file.empty() ? std::string("median")
                                    : std::string("given coefficients");
  const bool friction = property_of(options.property) == Property::friction;
  const double mean =
      friction ? degrees(field.mean_phi) : extent_of(values_shown(on_particles, options))["mean"].get<double>();
  text += ": mean " + figures::fixed(mean, 2) + what.unit;
  if (field.terms > 0)
    text += "; " + std::to_string(field.terms) + " terms carry " + figures::fixed(100 * field.captured_variance, 1) +
            " % of the variance";
  return text;
}

/// The measured angles, where they were measured.
std::vector<figures::Mark> marks_of(const std::optional<FieldSpec>& spec) {
  std::vector<figures::Mark> marks;
  if (!spec) return marks;
  for (const FieldDatum& datum : spec->data)
    marks.push_back({datum.x, figures::fixed(degrees(datum.phi), 1) + "°" +
                                  (datum.error > 0 ? " ± " + figures::fixed(degrees(datum.error), 1) : "")});
  return marks;
}

/// What the particles show of a realization.
Frame frame_of(const FieldOnParticles& field, const FieldOptions& options) {
  Frame frame;
  frame.n_soil = field.position.size();
  frame.position = field.position;
  frame.tan_phi = field.strength.properties.tan_phi;
  const Property property = property_of(options.property);
  if (property == Property::friction) return frame;
  std::vector<double> values = values_shown(field, options);
  for (double& value : values) value *= name_of(property).factor;
  (property == Property::cohesion      ? frame.cohesion
   : property == Property::unit_weight ? frame.density
                                       : frame.viscosity) = std::move(values);
  return frame;
}

/// The realization alone, or after the median and the standard deviation of all.
void draw(const FieldOnParticles& field, const Case& problem, const figures::Stamps& stamps,
          const FieldOptions& options) {
  const Frame frame = frame_of(field, options);
  const bool realization = options.realization.has_value() || !options.xi_file.empty();
  Frame median = frame;
  std::vector<figures::Snapshot> shots;
  if (field.spread) {
    median.tan_phi = field.spread->median_tan_phi;
    median.phi_stdev = field.spread->stdev_phi;
    const bool given_data = !problem.field->data.empty();
    shots.push_back({&median, figures::Colour::friction_angle, given_data ? "Median, given the data" : "Median"});
    shots.push_back({&median, figures::Colour::friction_stdev, "Standard deviation"});
  }
  if (!field.spread || realization)
    shots.push_back({&frame, shown_properties[index_of(property_of(options.property))].colour,
                     field.spread ? "Realization" : "Before the slide"});
  figures::plot_profiles(shots, problem.model.terrain, problem.model.dx, options.out, stamps,
                         {.mark_front = false, .marks = marks_of(problem.field)});
}

void write(const FieldOnParticles& field, const Case& problem, const figures::Stamps& stamps,
           const FieldOptions& options) {
  const fs::path& path = options.out;
  std::vector<NamedArray> arrays{{"friction_angle_deg", field.phi_deg}, {"tan_phi", field.strength.properties.tan_phi}};
  for (const Column& column : field.others) arrays.push_back({column.name, column.values});
  std::vector<double> median, stdev;
  if (field.spread) {
    for (const double tan_phi : field.spread->median_tan_phi) median.push_back(friction_angle_deg(tan_phi));
    for (const double angle : field.spread->stdev_phi) stdev.push_back(degrees(angle));
    arrays.push_back({"median_friction_angle_deg", median});
    arrays.push_back({"stdev_friction_angle_deg", stdev});
  }
  std::vector<Vec2> published = field.position;
  for (Vec2& x : published) x += problem.model.terrain.origin;
  if (path.extension() == ".csv") return write_field_csv(path, published, arrays);
  if (path.extension() == ".vtkhdf") return write_points(path, published, arrays);
  draw(field, problem, stamps, options);
}

Exit field(const FieldOptions& options) {
  LoadedCase loaded = load_case(options.case_file, options.overrides);
  Case& problem = loaded.value;
  if (!options.xi_file.empty()) use_xi(problem, options.xi_file);
  const auto& seed = options.seed ? options.seed : problem.study.seed;
  const RunIdentity identity{seed ? *seed : random_seed(), options.realization};
  if (options.spread && !problem.field)
    throw ConfigError("/random_field", "is missing: the case has no random field whose spread could be drawn");
  const FieldOnParticles on_particles = field_on(problem, identity, options.spread);
  const FieldSummary& of = on_particles.strength.summary;
  if (property_of(options.property) != Property::friction &&
      std::ranges::find(of.properties, options.property, &PropertySummary::name) == of.properties.end())
    throw ConfigError("/random_field", "does not draw " + options.property + ", which --property names");
  std::string source = "Talus " + version;
  if (identity.realization) source += "  ·  seed " + std::to_string(identity.seed);
  source += "  ·  case " + loaded.hash;
  if (!options.out.empty())
    write(on_particles, problem, {problem.title, subtitle(on_particles, options), source}, options);
  const Json numbers = summary(on_particles, identity);
  if (options.json) {
    std::cout << numbers.dump(2) << "\n";
    return Exit::ok;
  }
  std::cout << options.out.string() << "\n";
  const Json& phi = numbers["friction_angle_deg"];
  std::fprintf(stderr,
               "%zu particles, friction angle %.2f to %.2f deg, mean %.2f; %lld terms carry %.1f %% of the variance\n",
               on_particles.position.size(), phi["min"].get<double>(), phi["max"].get<double>(),
               phi["mean"].get<double>(), static_cast<long long>(of.terms), 100.0 * of.captured_variance);
  for (const Column& column : on_particles.others) {
    const Json extent = extent_of(column.values);
    std::fprintf(stderr, "%s %.4g to %.4g, mean %.4g\n", column.name.c_str(), extent["min"].get<double>(),
                 extent["max"].get<double>(), extent["mean"].get<double>());
  }
  return Exit::ok;
}

}  // namespace

void add_field(CLI::App& app, Action& action) {
  auto options = std::make_shared<FieldOptions>();
  CLI::App* verb =
      app.add_subcommand("field", "Write the random field of one realization as .csv, .vtkhdf, .svg or .png");
  add_case(*verb, options->case_file);
  verb->add_option("--out", options->out, "Output file; the format is taken from the extension; optional with --json")
      ->type_name("FILE")
      ->check(has_ending({".csv", ".vtkhdf", ".svg", ".png"}));
  auto* realization = verb->add_option("--realization", options->realization,
                                       "Index of the realization, from 0; without it the median field")
                          ->check(CLI::NonNegativeNumber);
  verb->add_option("--seed", options->seed,
                   "Seed of the random field; default: the case's, else a random one, which is "
                   "printed");
  verb->add_option("--xi", options->xi_file,
                   "Standard normal coefficients instead of drawn ones: one per line, or a CSV column xi")
      ->type_name("FILE")
      ->excludes(realization);
  verb->add_flag("--spread", options->spread,
                 "Also the median and the standard deviation over realizations, given the data: panels, or columns");
  std::set<std::string> names;
  for (const PropertyName& name : property_names) names.emplace(name.key);
  verb->add_option("--property", options->property, "Random property that a picture shows; tables have all of them")
      ->check(CLI::IsMember(names))
      ->capture_default_str();
  add_overrides(*verb, options->overrides);
  verb->add_flag("--json", options->json, "Print a summary with the coefficients as JSON");
  set_footer(*verb, {exit_text::bad_case, exit_text::io},
             {"field slope.json --realization 0 --out field.svg",
              "field slope.json --realization 0 --spread --out spread.png", "field slope.json --out median.csv"});
  verb->callback([options, &action] {
    if (options->out.empty() && !options->json) throw CLI::RequiredError("--out");
    action = [options] { return field(*options); };
  });
}

}  // namespace talus::cli
