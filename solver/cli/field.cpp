// talus field: the random field of one realization, as numbers or as a picture, without running it.

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <iostream>
#include <iterator>
#include <memory>
#include <numeric>
#include <set>
#include <span>

#include "case/load.hpp"
#include "cli/field_on_particles.hpp"
#include "cli/help.hpp"
#include "cli/verbs.hpp"
#include "cli/xi_file.hpp"
#include "figures/ground.hpp"
#include "figures/profile.hpp"
#include "io/vtkhdf.hpp"
#include "math/angle.hpp"
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
  std::string property;  ///< key of property_names; empty: the first that varies
  bool json = false;
};

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
  const FieldSummary& of = field.strength.summary;
  Json friction = extent_of(field.columns.front().values);
  friction["mean"] = degrees(of.mean_phi);
  Json out = {{"particles", field.position.size()},
              {"captured_variance", of.captured_variance},
              {"cov_tan_phi", of.cov},
              {"terms", of.terms},
              {"friction_angle_deg", std::move(friction)},
              {"realization", identity.realization ? Json(*identity.realization) : Json()},
              {"seed", identity.realization ? Json(identity.seed) : Json()},
              {"xi", field.strength.xi}};
  for (const Column& column : std::span(field.columns).subspan(1)) out[column.name] = extent_of(column.values);
  return out;
}

/// What a picture says of a property: its name, its unit, the colours of its values and of their standard deviation.
struct Shown {
  const char* name;
  const char* unit;
  figures::Colour value, stdev;
};
constexpr Shown shown_properties[] = {
    {"Friction angle", "°", figures::Colour::friction_angle, figures::Colour::friction_stdev},
    {"Cohesion", " kPa", figures::Colour::cohesion, figures::Colour::cohesion_stdev},
    {"Unit weight", " kN/m3", figures::Colour::unit_weight, figures::Colour::unit_weight_stdev},
    {"Viscosity", " Pa s", figures::Colour::viscosity, figures::Colour::viscosity_stdev}};
static_assert(std::size(shown_properties) == property_count);

const std::vector<double>& values_shown(const FieldOnParticles& field) {
  const std::string prefix = std::string(name_of(field.shown).key) + "_";
  return std::ranges::find_if(field.columns, [&](const Column& c) { return c.name.starts_with(prefix); })->values;
}

std::string subtitle(const FieldOnParticles& field, const FieldOptions& options) {
  const FieldSummary& of = field.strength.summary;
  const Shown& what = shown_properties[index_of(field.shown)];
  std::string text = std::string(what.name) + ", ";
  text += options.realization       ? "realization " + std::to_string(*options.realization)
          : options.xi_file.empty() ? std::string("median")
                                    : std::string("given coefficients");
  const bool friction = field.shown == Property::friction;
  const double mean = friction ? degrees(of.mean_phi) : extent_of(values_shown(field))["mean"].get<double>();
  text += ": mean " + figures::fixed(mean, 2) + what.unit;
  if (of.terms > 0)
    text += "; " + std::to_string(of.terms) + " terms carry " + figures::fixed(100 * of.captured_variance, 1) +
            " % of the variance";
  return text;
}

/// The measured values of the property shown, where they were measured.
std::vector<figures::Mark> marks_of(const std::optional<FieldSpec>& spec, Property shown) {
  std::vector<figures::Mark> marks;
  if (!spec) return marks;
  const double unit = shown == Property::friction ? radians(1.0) : name_of(shown).factor;
  for (const FieldDatum& datum : spec->data)
    if (datum.property == shown)
      marks.push_back({datum.x, figures::fixed(datum.value / unit, 1) + shown_properties[index_of(shown)].unit +
                                    (datum.error > 0 ? " ± " + figures::fixed(datum.error / unit, 1) : "")});
  return marks;
}

/// Particles with values of a property in SI units.
Frame frame_with(const FieldOnParticles& field, std::vector<double> values) {
  Frame frame;
  frame.n_soil = field.position.size();
  frame.position = field.position;
  std::vector<double>* const arrays[] = {&frame.tan_phi, &frame.cohesion, &frame.density, &frame.viscosity};
  *arrays[index_of(field.shown)] = std::move(values);
  return frame;
}

/// In SI units, from the columns.
std::vector<double> values_of(const FieldOnParticles& field) {
  if (field.shown == Property::friction) return field.strength.properties.tan_phi;
  std::vector<double> values = values_shown(field);
  for (double& value : values) value *= name_of(field.shown).factor;
  return values;
}

/// The realization alone, or after the median and the standard deviation of all.
void draw(const FieldOnParticles& field, const Case& problem, const figures::Stamps& stamps,
          const FieldOptions& options) {
  const Shown& what = shown_properties[index_of(field.shown)];
  const Frame frame = frame_with(field, values_of(field));
  const bool realization = options.realization.has_value() || !options.xi_file.empty();
  Frame median;
  std::vector<figures::Snapshot> shots;
  if (field.spread) {
    median = frame_with(field, field.spread->median);
    median.stdev = field.spread->stdev;
    const bool given_data = !problem.field->data.empty();
    shots.push_back({&median, what.value, given_data ? "Median, given the data" : "Median"});
    shots.push_back({&median, what.stdev, "Standard deviation"});
  }
  if (!field.spread || realization)
    shots.push_back({&frame, what.value, field.spread ? "Realization" : "Before the slide"});
  figures::plot_profiles(shots, problem.model.terrain, problem.model.dx, options.out, stamps,
                         {.mark_front = false,
                          .marks = marks_of(problem.field, field.shown),
                          .structures = figures::structures_of(problem.model)});
}

void write(const FieldOnParticles& field, const Case& problem, const figures::Stamps& stamps,
           const FieldOptions& options) {
  const fs::path& path = options.out;
  std::vector<NamedArray> arrays{{field.columns.front().name, field.columns.front().values},
                                 {"tan_phi", field.strength.properties.tan_phi}};
  for (const Column& column : std::span(field.columns).subspan(1)) arrays.push_back({column.name, column.values});
  for (const Column& column : field.spreads) arrays.push_back({column.name, column.values});
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
  const Property shown = options.property.empty() ? first_random(problem) : property_of(options.property);
  const FieldOnParticles on_particles = field_on(problem, identity, shown, options.spread);
  const FieldSummary& of = on_particles.strength.summary;
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
  for (const Column& column : std::span(on_particles.columns).subspan(1)) {
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
  verb->add_option("--property", options->property,
                   "Random property that a picture shows, default: the first that varies; tables have all of them")
      ->check(CLI::IsMember(names));
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
