// Material, rheology, numerics, walls, time: keys, units, ranges. Defaults are those of the structs.

#include <cmath>
#include <cstdint>
#include <numbers>

#include "case/sections.hpp"

namespace talus {
namespace {

constexpr Quantity friction_angle{"deg", 0.0, 90.0, false, true};
constexpr Quantity duration{"s", 0.0, 1e7, true};
constexpr std::size_t most_snapshots = 10'000;

constexpr Names<ShearRate> shear_rates[] = {{"consistent", ShearRate::consistent}, {"paper", ShearRate::paper}};
constexpr Names<Yield> yields[] = {{"elastic", Yield::elastic}, {"regularized", Yield::regularized}};
constexpr Names<KernelShape> kernels[] = {{"cubic_spline", KernelShape::cubic_spline},
                                          {"wendland_c2", KernelShape::wendland_c2}};
constexpr Names<Continuity> continuities[] = {{"volume", Continuity::volume}, {"mass", Continuity::mass}};
constexpr Names<DensityFilter> filters[] = {
    {"shepard", DensityFilter::shepard}, {"delta_sph", DensityFilter::delta_sph}, {"none", DensityFilter::none}};
constexpr Names<InitialPressure> initial_pressures[] = {{"hydrostatic", InitialPressure::hydrostatic},
                                                        {"stress_free", InitialPressure::stress_free}};
constexpr Names<Precision> precisions[] = {{"single", Precision::single}, {"double", Precision::full}};
constexpr Names<Integrator> integrators[] = {{"rk2", Integrator::rk2}, {"leapfrog", Integrator::leapfrog}};
constexpr Names<WallContact> contacts[] = {{"always", WallContact::always}, {"approaching", WallContact::approaching}};
constexpr Names<WallSlip> slips[] = {
    {"no_slip", WallSlip::no_slip}, {"friction", WallSlip::friction}, {"free_slip", WallSlip::free_slip}};

/// Times 0 < interval < 2 interval ... < end, where an end within a hair of a multiple counts as that multiple.
std::vector<double> every(double interval, double end) {
  std::vector<double> times;
  for (std::int64_t k = 1; static_cast<double>(k) * interval < end * (1.0 - 1e-12); ++k)
    times.push_back(static_cast<double>(k) * interval);
  return times;
}

std::vector<double> read_snapshots(ObjectReader& in, double end) {
  const auto interval = in.maybe_number("snapshot_interval_s", duration);
  std::vector<double> times = in.numbers("snapshot_times_s", {"s", 0.0, 1e7}, most_snapshots);
  if (interval && in.find("snapshot_times_s") != nullptr)
    in.fault("snapshot_interval_s", "is given beside snapshot_times_s; give one of the two");
  for (std::size_t k = 0; k < times.size(); ++k) {
    if (times[k] > end) in.faults().add(pointer_to(in.pointer("snapshot_times_s"), k), "lies after end_s");
    if (k > 0 && times[k] <= times[k - 1])
      in.faults().add(pointer_to(in.pointer("snapshot_times_s"), k), "does not exceed the time before it");
  }
  if (interval && end / *interval > static_cast<double>(most_snapshots))
    in.fault("snapshot_interval_s", "makes more than " + std::to_string(most_snapshots) + " snapshots until end_s");
  else if (interval && times.empty())
    times = every(*interval, end);
  return times;
}

/// false, true (the default rule) or the rule itself.
std::optional<StopAtRest> read_stop(ObjectReader& in) {
  const Json* value = in.find("stop_at_rest");
  in.record("stop_at_rest", false);
  if (value == nullptr || *value == false) return {};
  const Json defaults = Json::object();
  ObjectReader rule(*value == true ? defaults : *value, in.pointer("stop_at_rest"), in.faults());
  StopAtRest stop;
  stop.speed = rule.number("speed_m_s", {"m/s", 0.0, 1000.0, true}, stop.speed);
  stop.hold = rule.number("hold_s", {"s", 0.0, 1e6}, stop.hold);
  in.record("stop_at_rest", rule.finish());
  return stop;
}

}  // namespace

double radians(double degrees) { return degrees * (std::numbers::pi / 180.0); }

Material read_material(ObjectReader& in, const Json* base) {
  const auto standard = [&](const char* key, std::optional<double> otherwise = {}) {
    return base == nullptr ? otherwise : std::optional(base->at(key).get<double>());
  };
  Material m;
  m.name = in.text("name", 1, 100, base == nullptr ? m.name : base->at("name").get<std::string>());
  m.rho0 = in.number("density_kg_m3", {"kg/m3", 0.0, 1e5, true}, standard("density_kg_m3"));
  m.phi = radians(in.number("friction_angle_deg", friction_angle, standard("friction_angle_deg")));
  m.c = in.number("cohesion_Pa", {"Pa", 0.0, 1e9}, standard("cohesion_Pa", m.c));
  m.eta = in.number("viscosity_Pa_s", {"Pa s", 0.0, 1e9}, standard("viscosity_Pa_s", m.eta));
  return m;
}

Rheology read_rheology(ObjectReader in, Json& resolved) {
  Rheology r;
  r.shear_rate = in.choice("shear_rate", shear_rates, r.shear_rate);
  r.yield = in.choice("yield", yields, r.yield);
  r.gamma_dot_min = in.number("min_shear_rate_1_s", {"1/s", 0.0, 1000.0, true}, r.gamma_dot_min);
  r.G = in.maybe_number("shear_modulus_Pa", {"Pa", 0.0, 1e15, true});
  resolved = in.finish();
  return r;
}

Numerics read_numerics(ObjectReader in, Json& resolved) {
  Numerics n;
  n.kernel = in.choice("kernel", kernels, n.kernel);
  n.h_over_dx = in.number("smoothing_ratio", {"", 1.0, 2.0}, n.h_over_dx);
  n.c_s = in.maybe_number("sound_speed_m_s", {"m/s", 0.0, 1e5, true});
  n.alpha = in.number("artificial_viscosity_alpha", {"", 0.0, 10.0}, n.alpha);
  n.beta = in.number("artificial_viscosity_beta", {"", 0.0, 10.0}, n.beta);
  n.continuity = in.choice("continuity", continuities, n.continuity);
  n.density_filter = in.choice("density_filter", filters, n.density_filter);
  n.filter_interval = static_cast<int>(in.integer("filter_interval_steps", {"", 1.0, 1e6}, n.filter_interval));
  n.delta = in.number("delta_sph_coefficient", {"", 0.0, 1.0}, n.delta);
  n.tension_cutoff = in.flag("tension_cutoff", n.tension_cutoff);
  n.initial_pressure = in.choice("initial_pressure", initial_pressures, n.initial_pressure);
  n.integrator = in.choice("integrator", integrators, n.integrator);
  n.precision = in.choice("precision", precisions, n.precision);
  n.cfl = in.number("cfl", {"", 0.0, 1.0, true}, n.cfl);
  resolved = in.finish();
  return n;
}

Walls read_walls(ObjectReader in, Json& resolved) {
  Walls w;
  w.contact = in.choice("contact", contacts, w.contact);
  w.slip = in.choice("slip", slips, w.slip);
  const std::optional<double> phi = in.maybe_number("friction_angle_deg", friction_angle);
  if (w.slip == WallSlip::friction && in.find("friction_angle_deg") == nullptr)
    in.fault("friction_angle_deg",
             "is missing: slip \"friction\" needs the wall's angle; " + friction_angle.describe());
  w.phi = radians(phi.value_or(0.0));
  w.b_max = in.number("max_velocity_ratio", {"", 1.0, 100.0}, w.b_max);
  w.layers = static_cast<int>(in.integer("layers", {"", 1.0, 20.0}, w.layers));
  resolved = in.finish();
  return w;
}

TimeControl read_time(ObjectReader in, Json& resolved) {
  TimeControl t;
  t.end = in.number("end_s", duration);
  t.fixed_step = in.maybe_number("fixed_step_s", duration);
  t.max_step = in.maybe_number("max_step_s", duration);
  if (t.fixed_step && t.max_step) in.fault("max_step_s", "has no effect beside fixed_step_s; give one of the two");
  t.snapshots = read_snapshots(in, t.end);
  t.stop_at_rest = read_stop(in);
  resolved = in.finish();
  resolved.erase("snapshot_interval_s");
  resolved["snapshot_times_s"] = t.snapshots;
  return t;
}

}  // namespace talus
