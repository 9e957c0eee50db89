// talus validate CASE: all faults of a case, or what running it will take.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>

#include "case/ground_report.hpp"
#include "cli/help.hpp"
#include "cli/verbs.hpp"
#include "material/soil_types.hpp"
#include "math/angle.hpp"
#include "particles/geometry.hpp"
#include "run/dissipation.hpp"
#include "run/realization.hpp"
#include "run/warnings.hpp"
#include "simulation/pore_pressure.hpp"
#include "simulation/simulation.hpp"
#include "support/json.hpp"
#include "support/run_memory.hpp"

namespace talus::cli {
namespace {

struct ValidateOptions {
  std::filesystem::path case_file;
  std::vector<std::string> overrides;
  bool json = false;
  bool soils = false;
};

/// What a run of the case takes.
struct Demand {
  std::size_t soil = 0, wall = 0;
  SlideMass mass;
  double step = 0.0;  ///< [s]
  double steps = 0.0;
  double memory = 0.0;  ///< [bytes]
  FlowConstants flow;
  std::optional<FieldSummary> field;
  std::optional<PorePressureSummary> water;
  std::vector<Fault> warnings;
};

Demand measure(const Case& c) {
  Demand d;
  const ParticlePlan plan = plan_particles(c.model);
  d.soil = plan.soil.size();
  d.wall = plan.walls.size();
  d.mass = slide_mass(c.model, plan);
  d.step = first_step(c.model);
  d.steps = std::ceil(c.model.time.end / d.step * (1.0 - 1e-12));
  d.memory = run_memory(static_cast<double>(d.soil + d.wall));
  d.flow = flow_constants(c.model);
  if (c.field) d.field = field_summary(c.model, *c.field, plan);
  if (has_pore_pressure(c.model)) d.water = summary_of(pore_pressure_ratios(c.model, plan.soil));
  d.warnings = warnings_before_run(c, plan, d.field.value_or(FieldSummary{}));
  return d;
}

Json to_json(const std::vector<Fault>& faults) {
  Json list = Json::array();
  for (const Fault& f : faults) list.push_back({{"pointer", f.pointer}, {"message", f.message}});
  return list;
}

void print_json(const Json& value) { std::cout << value.dump(2, ' ', false, Json::error_handler_t::replace) << "\n"; }

const char* direction_of(const RunOutAxis& axis) { return axis.to == SlidesTo::right ? "right" : "left"; }

Json end_json(bool wall, Vec2 end, double wall_top) {
  Json out = {{"kind", wall ? "wall" : "open"}, {"x_m", end.x}, {"y_m", end.y}};
  if (wall) out["top_m"] = wall_top;
  return out;
}

Json to_json(const GroundReport& r, const Terrain& terrain) {
  Json out = {{"source", r.source},
              {"vertices", {{"given", r.given}, {"kept", r.kept}}},
              {"noise_m", r.fitted.noise},
              {"moved_m", r.fitted.moved},
              {"notches", {{"filled", r.fitted.notches}, {"deepest_m", r.fitted.deepest_notch}}}};
  if (terrain.closed) return out;
  out["left_end"] =
      end_json(terrain.left_wall, terrain.bed.front() + terrain.origin, terrain.left_wall_top() + terrain.origin.y);
  out["right_end"] =
      end_json(terrain.right_wall, terrain.bed.back() + terrain.origin, terrain.right_wall_top() + terrain.origin.y);
  return out;
}

Json slide_json(const GroundReport& r, const Model& model) {
  return {{"x_m", {r.slide.lo.x, r.slide.hi.x}},
          {"y_m", {r.slide.lo.y, r.slide.hi.y}},
          {"thickness_m", r.thickness},
          {"thickness_spacings", r.thickness / model.dx},
          {"slides_to", direction_of(model.terrain.run_out)},
          {"measured_from_m", model.terrain.run_out.from + model.terrain.origin.x}};
}

/// mu_2 of a type of soil as an angle, on top of the friction of the case [deg].
double high_rate_angle(const SoilType& type, const Model& model) {
  return degrees(std::atan(std::tan(model.materials.front().phi) + type.delta_mu));
}

Json proposals_json(const Model& model) {
  Json list = Json::array();
  for (const SoilType& type : soil_types) {
    Json proposal = {{"soil", type.name}, {"source", type.source}};
    if (type.eta > 0.0) {
      proposal["viscosity_Pa_s"] = type.eta;
      proposal["range_Pa_s"] = {type.eta_low, type.eta_high};
    } else {
      proposal["mu_i"] = {{"high_rate_friction_angle_deg", high_rate_angle(type, model)},
                          {"friction_rise", type.delta_mu},
                          {"reference_inertial_number", type.I_0}};
    }
    list.push_back(proposal);
  }
  return list;
}

void print_proposals(const Model& model) {
  std::printf(
      "rate dependence    none is stated: the run-out then depends on the numerical dissipation, which falls with the\n"
      "                   spacing. Measured or back-analysed values by soil type (key of material, value, range):\n");
  for (const SoilType& type : soil_types) {
    std::printf("  %-48s", type.name);
    if (type.eta == 0.0)
      std::printf("mu_i: high_rate_friction_angle_deg %.1f, reference_inertial_number %g", high_rate_angle(type, model),
                  type.I_0);
    else if (type.eta_low < type.eta_high)
      std::printf("viscosity_Pa_s %g (%g to %g)", type.eta, type.eta_low, type.eta_high);
    else
      std::printf("viscosity_Pa_s %g (one value)", type.eta);
    std::printf("\n      %s\n", type.source);
  }
}

Json strengths_json() {
  Json list = Json::array();
  for (const StrengthValue& value : strength_values)
    list.push_back(
        {{"soil", value.soil}, {"key", value.key}, {"range", {value.low, value.high}}, {"source", value.source}});
  return list;
}

void print_strengths() {
  std::printf("strength           values by soil type (key of material or of its softening, range):\n");
  for (const StrengthValue& value : strength_values) {
    std::printf("  %-60s %s %g", value.soil, value.key, value.low);
    if (value.low < value.high) std::printf(" to %g", value.high);
    std::printf("\n      %s\n", value.source);
  }
}

/// The numerical constants that have defaults in words.
Json numerics_json(const FlowConstants& flow) {
  Json moduli = Json::array();
  for (const ConstitutiveParameters& soil : flow.soils) moduli.push_back(soil.G);
  return {{"sound_speed_m_s", flow.c_s}, {"shear_modulus_Pa", moduli}};
}

const PropertyName& unit_of(const PropertySummary& p) {
  return *std::ranges::find(property_names, p.name, &PropertyName::key);
}

Json to_json(const LoadedCase& loaded, const Demand& d) {
  Json out = {{"valid", true},
              {"title", loaded.value.title},
              {"hash", loaded.hash},
              {"particles", {{"soil", d.soil}, {"wall", d.wall}}},
              {"step_s", d.step},
              {"steps", d.steps},
              {"memory_bytes", d.memory},
              {"mass_kg_m", {{"filled", d.mass.filled}, {"outline", d.mass.outline}}}};
  const Model& model = loaded.value.model;
  const GroundReport report = report_ground(loaded);
  out["files"] = loaded.files;
  out["ground"] = to_json(report, model.terrain);
  out["slide"] = slide_json(report, model);
  out["numerics"] = numerics_json(d.flow);
  if (d.field)
    out["field"] = {
        {"terms", d.field->terms}, {"captured_variance", d.field->captured_variance}, {"cov_tan_phi", d.field->cov}};
  if (d.water)
    out["water"] = {
        {"wet_particles", d.water->wet}, {"liquefied_particles", d.water->liquefied}, {"mean_ratio", d.water->mean}};
  if (d.field)
    for (const PropertySummary& p : d.field->properties)
      out["field"]["properties"][p.name] = {{"mean_" + std::string(unit_of(p).suffix), p.mean}, {"cov", p.cov}};
  if (lacks_rate_dependence(model)) out["rate_dependence_by_soil"] = proposals_json(model);
  out["strength_by_soil"] = strengths_json();
  out["warnings"] = to_json(loaded.warnings);
  return out;
}

void print_field(const FieldSummary& field) {
  std::printf("captured variance  %.2f %% with %lld terms", 100.0 * field.captured_variance,
              static_cast<long long>(field.terms));
  if (field.properties.empty()) std::printf("; coefficient of variation of tan(phi) %.3g", field.cov);
  std::printf("\n");
  for (const PropertySummary& p : field.properties)
    std::printf("%-18s mean %.4g %s, coefficient of variation %.3g\n", p.name.c_str(), p.mean,
                unit_of(p).unit.empty() ? "(tangent)" : std::string(unit_of(p).unit).c_str(), p.cov);
}

void print_end(const char* name, bool wall, Vec2 end, double wall_top) {
  std::printf("%-18s %s at (%.10g, %.10g)", name, wall ? "wall" : "open", end.x, end.y);
  if (wall) std::printf(" up to y = %.10g m", wall_top);
  std::printf("\n");
}

void print_ground(const GroundReport& r, const Model& model) {
  const FittedLine& f = r.fitted;
  std::printf("ground             %s: %zu vertices, %zu after fitting to the spacing\n", r.source.c_str(), r.given,
              r.kept);
  if (f.noise > 0.0) std::printf("                   noise of the survey %.2g m (standard deviation)\n", f.noise);
  if (f.moved > 0.0) std::printf("                   vertices lie at most %.2g m from the fitted line\n", f.moved);
  if (f.notches > 0)
    std::printf("                   %d %s narrower than a particle filled, at most %.2g m deep\n", f.notches,
                f.notches == 1 ? "notch" : "notches", f.deepest_notch);
  const Terrain& t = model.terrain;
  if (!t.closed) print_end("left end", t.left_wall, t.bed.front() + t.origin, t.left_wall_top() + t.origin.y);
  if (!t.closed) print_end("right end", t.right_wall, t.bed.back() + t.origin, t.right_wall_top() + t.origin.y);
  std::printf("slide              x = %.10g to %.10g m, y = %.10g to %.10g m, at most %.3g m thick (%.3g spacings)\n",
              r.slide.lo.x, r.slide.hi.x, r.slide.lo.y, r.slide.hi.y, r.thickness, r.thickness / model.dx);
}

void print_text(const LoadedCase& loaded, const Demand& d) {
  std::printf("%s\n", loaded.value.title.c_str());
  for (const std::string& file : loaded.files) std::printf("file               %s\n", file.c_str());
  print_ground(report_ground(loaded), loaded.value.model);
  std::printf("particles          %zu soil + %zu wall\n", d.soil, d.wall);
  std::printf("mass               %.0f kg/m, %+.2f %% against density x area of the outlines\n", d.mass.filled,
              std::round(1e4 * (d.mass.filled / d.mass.outline - 1.0)) / 100.0 + 0.0);
  const RunOutAxis& axis = loaded.value.model.terrain.run_out;
  std::printf("slides to          the %s; run-outs from x = %.10g m\n", direction_of(axis),
              axis.from + loaded.value.model.terrain.origin.x);
  std::printf("time step          %.3g s%s\n", d.step,
              loaded.value.model.time.fixed_step ? " (fixed)" : " at the start");
  std::printf("steps              about %.0f to %.4g s\n", d.steps, loaded.value.model.time.end);
  std::printf("memory             about %.0f MB\n", d.memory / 1e6);
  if (d.field) print_field(*d.field);
  if (d.water)
    std::printf(
        "water              %lld of %zu particles, pore pressure over normal stress %.2g on average; %lld without "
        "effective stress\n",
        static_cast<long long>(d.water->wet), d.soil, d.water->mean, static_cast<long long>(d.water->liquefied));
  std::printf("case hash          %s\n", loaded.hash.c_str());
  if (lacks_rate_dependence(loaded.value.model)) print_proposals(loaded.value.model);
  print_warnings(loaded.warnings);
}

Exit validate(const ValidateOptions& options) try {
  LoadedCase loaded = load_case(options.case_file, options.overrides);
  Demand demand = measure(loaded.value);
  std::ranges::move(demand.warnings, std::back_inserter(loaded.warnings));
  options.json ? print_json(to_json(loaded, demand)) : print_text(loaded, demand);
  if (options.soils && !options.json) print_strengths();
  return Exit::ok;
} catch (const ConfigError& e) {
  if (!options.json) throw;
  print_json({{"valid", false}, {"faults", to_json(e.faults)}});
  return Exit::bad_case;
}

}  // namespace

void add_validate(CLI::App& app, Action& action) {
  const auto options = std::make_shared<ValidateOptions>();
  CLI::App* verb = app.add_subcommand("validate",
                                      "Check a case: list all errors with their location, or report what "
                                      "running it takes");
  add_case(*verb, options->case_file);
  add_overrides(*verb, options->overrides);
  verb->add_flag("--json", options->json, "Print the report as JSON");
  verb->add_flag(
      "--soils", options->soils,
      "Also print values of pore pressure, undrained and residual strength by soil type, with their sources");
  set_footer(*verb, {exit_text::bad_case, exit_text::io},
             {"validate slope.json", "validate slope.json --set particle_spacing_m=0.2"});
  verb->callback([&action, options] { action = [options] { return validate(*options); }; });
}

}  // namespace talus::cli
