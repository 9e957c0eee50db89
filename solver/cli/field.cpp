// talus field: the friction angle of one realization, as numbers or as a picture, without running it.

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <iostream>
#include <memory>

#include "case/load.hpp"
#include "cli/help.hpp"
#include "cli/verbs.hpp"
#include "cli/xi_file.hpp"
#include "figures/ground.hpp"
#include "figures/profile.hpp"
#include "io/vtkhdf.hpp"
#include "math/angle.hpp"
#include "random_field/random_field.hpp"
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
  bool json = false;
};

/// The field on the particles before they move.
struct FieldOnParticles {
  std::vector<Vec2> position;   ///< [m]
  std::vector<double> phi_deg;  ///< [deg]
  Strength strength;
  std::optional<FieldSpread> spread;  ///< median and standard deviation over realizations, where they are asked for
};

FieldOnParticles field_on(const Case& problem, const RunIdentity& identity, bool spread) {
  const ParticlePlan plan = plan_particles(problem.model);
  FieldOnParticles field{.position = {},
                         .phi_deg = {},
                         .strength = strength(problem.model, problem.field, problem.study, plan, identity),
                         .spread = {}};
  for (const SoilPoint& point : plan.soil) field.position.push_back(point.x);
  for (const double tan_phi : field.strength.properties.tan_phi) field.phi_deg.push_back(friction_angle_deg(tan_phi));
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
  const std::size_t terms = make_field(problem.model, *problem.field).terms();
  if (xi.size() != terms) {
    throw ConfigError(file.string(),
                      "holds " + std::to_string(xi.size()) + " coefficients, the field takes " + std::to_string(terms) +
                          " (--set random_field.terms=" + std::to_string(xi.size()) + " would make it fit)");
  }
  problem.field->xi = xi;
}

Json summary(const FieldOnParticles& field, const RunIdentity& identity) {
  const auto [lo, hi] = std::minmax_element(field.phi_deg.begin(), field.phi_deg.end());
  const FieldSummary& of = field.strength.summary;
  return {{"particles", field.position.size()},
          {"captured_variance", of.captured_variance},
          {"cov_tan_phi", of.cov},
          {"terms", of.terms},
          {"friction_angle_deg", {{"mean", degrees(of.mean_phi)}, {"min", *lo}, {"max", *hi}}},
          {"realization", identity.realization ? Json(*identity.realization) : Json()},
          {"seed", identity.realization ? Json(identity.seed) : Json()},
          {"xi", field.strength.xi}};
}

std::string subtitle(const FieldSummary& field, const FieldOptions& options) {
  std::string text = "Friction angle, ";
  text += options.realization       ? "realization " + std::to_string(*options.realization)
          : options.xi_file.empty() ? std::string("median")
                                    : std::string("given coefficients");
  text += ": mean " + figures::fixed(degrees(field.mean_phi), 2) + "°";
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

/// The realization alone, or after the median and the standard deviation of all.
void draw(const FieldOnParticles& field, const Case& problem, const figures::Stamps& stamps, const fs::path& path,
          bool realization) {
  Frame frame;
  frame.n_soil = field.position.size();
  frame.position = field.position;
  frame.tan_phi = field.strength.properties.tan_phi;
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
    shots.push_back({&frame, figures::Colour::friction_angle, field.spread ? "Realization" : "Before the slide"});
  figures::plot_profiles(
      shots, problem.model.terrain, problem.model.dx, path, stamps,
      {.mark_front = false, .marks = marks_of(problem.field), .structures = figures::structures_of(problem.model)});
}

void write(const FieldOnParticles& field, const Case& problem, const figures::Stamps& stamps, const fs::path& path,
           bool realization) {
  std::vector<NamedArray> arrays{{"friction_angle_deg", field.phi_deg}, {"tan_phi", field.strength.properties.tan_phi}};
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
  draw(field, problem, stamps, path, realization);
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
  std::string source = "Talus " + version;
  if (identity.realization) source += "  ·  seed " + std::to_string(identity.seed);
  source += "  ·  case " + loaded.hash;
  if (!options.out.empty())
    write(on_particles, problem, {problem.title, subtitle(of, options), source}, options.out,
          options.realization.has_value() || !options.xi_file.empty());
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
  return Exit::ok;
}

}  // namespace

void add_field(CLI::App& app, Action& action) {
  auto options = std::make_shared<FieldOptions>();
  CLI::App* verb =
      app.add_subcommand("field", "Write the friction angle of one realization as .csv, .vtkhdf, .svg or .png");
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
