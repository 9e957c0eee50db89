// The keys of material, rheology, numerics and time. Defaults are those of the structs.

#include <cmath>
#include <cstdint>

#include "case/sections.hpp"
#include "math/angle.hpp"
#include "simulation/checks.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

constexpr Quantity duration{"s", 0.0, 1e7, true};
constexpr double laboratory_gravity = 9.81;  ///< with which laboratories state unit weights [m/s2]
constexpr std::size_t most_snapshots = 10'000;

constexpr Names<ShearRate> shear_rates[] = {{"consistent", ShearRate::consistent}, {"paper", ShearRate::paper}};
constexpr Names<Yield> yields[] = {{"elastic", Yield::elastic}, {"regularized", Yield::regularized}};
constexpr Names<KernelShape> kernels[] = {{"cubic_spline", KernelShape::cubic_spline},
                                          {"wendland_c2", KernelShape::wendland_c2}};
constexpr Names<VelocityJump> jumps[] = {{"reconstructed", VelocityJump::reconstructed},
                                         {"whole", VelocityJump::whole}};
constexpr Names<Continuity> continuities[] = {{"volume", Continuity::volume}, {"mass", Continuity::mass}};
constexpr Names<DensityFilter> filters[] = {
    {"shepard", DensityFilter::shepard}, {"delta_sph", DensityFilter::delta_sph}, {"none", DensityFilter::none}};
constexpr Names<InitialPressure> initial_pressures[] = {{"hydrostatic", InitialPressure::hydrostatic},
                                                        {"stress_free", InitialPressure::stress_free}};
constexpr Names<Precision> precisions[] = {{"single", Precision::single}, {"double", Precision::full}};
constexpr Names<Integrator> integrators[] = {{"rk2", Integrator::rk2}, {"leapfrog", Integrator::leapfrog}};

/// Times 0 < interval < 2 interval ... < end, where an end that differs from a multiple by rounding counts as that
/// multiple.
std::vector<double> every(double interval, double end) {
  std::vector<double> times;
  for (std::int64_t k = 1; static_cast<double>(k) * interval < end * (1.0 - 1e-12); ++k)
    times.push_back(static_cast<double>(k) * interval);
  return times;
}

/// Snapshots are given as times or as an interval, which the resolved case spells out.
void read_snapshots(ObjectReader& in, TimeControl& t) {
  in.numbers("snapshot_times_s", t.snapshots, {"s", 0.0, 1e7}, {0, most_snapshots},
             {"Times of the snapshots, increasing, up to end_s; start and end are always kept.", "user", "",
              ">= 0 and <= end_s"});
  std::optional<double> interval;
  in.optional_number(
      "snapshot_interval_s", interval, duration,
      {"Snapshots at every multiple of this; not together with snapshot_times_s; at most 10000 until end_s.", "user",
       "none"});
  in.exclude("snapshot_interval_s", "snapshot_times_s");
  for (std::size_t k = 0; k < t.snapshots.size(); ++k) {
    const std::string place = pointer_to(in.pointer("snapshot_times_s"), k);
    if (t.snapshots[k] > t.end) in.faults().add(place, "lies after end_s");
    if (k > 0 && t.snapshots[k] <= t.snapshots[k - 1]) in.faults().add(place, "does not exceed the time before it");
  }
  if (interval && t.end / *interval > static_cast<double>(most_snapshots))
    in.fault("snapshot_interval_s", "makes more than " + std::to_string(most_snapshots) + " snapshots until end_s");
  else if (interval && t.snapshots.empty())
    t.snapshots = every(*interval, t.end);
  in.remove_record("snapshot_interval_s");
  in.flag(
      "snapshots_exact", t.snapshots_exact,
      {"Shorten time steps so that snapshots are exactly at the times asked for, the same in every realization, which "
       "changes results in their last digits; otherwise each is that of the first step at or after its time.",
       "user", "false"});
  if (!t.snapshots_exact) in.remove_record("snapshots_exact");  // the hash of earlier cases stays
}

/// @param m  its high_rate_friction_angle_deg is read, mu_i is set but for delta_mu
void read_inertial_friction(ObjectReader& in, MaterialInput& m) {
  InertialFriction<> mu_i;
  in.required_number("high_rate_friction_angle_deg", m.high_rate_friction_angle_deg, friction_angle_range,
                     {"Friction angle at high shear rates, tan = mu_2; more than friction_angle_deg, whose tangent is "
                      "mu_s. A random field varies mu_s; mu_2 - mu_s stays.",
                      "inclined plane or rotating drum; Jop et al. 2006", "", "> friction_angle_deg and <= 89"});
  in.number(
      "reference_inertial_number", mu_i.I_0, {"", 0.0, 100.0, true},
      {"Inertial number I_0 at which friction has risen by half of mu_2 - mu_s.", "Jop et al. 2006 for glass beads"});
  in.number_in_either(
      "grain_diameter_m", mu_i.d, {"m", 0.0, 10.0, true},
      {"Mean diameter d of the grains.", "sieve analysis", "none, required unless grain_diameter_mm is given"}, true,
      {"grain_diameter_mm", {"mm", 0.0, 1e4, true}, 1e-3, {"The same in mm.", "sieve analysis", "none"}});
  in.number("grain_density_kg_m3", mu_i.rho_s, {"kg/m3", 0.0, 1e5, true},
            {"Density of the grains themselves.", "pycnometer; 2650 for quartz"});
  in.number("high_rate_slope", mu_i.mu_inf, {"", 0.0, 10.0},
            {"Slope of mu(I) far above I_0, which keeps the equations well posed; 0: mu(I) levels off at mu_2.",
             "Barker & Gray 2017"});
  m.mu_i = mu_i;
}

/// Viscosity or mu(I). A layer that states one of them drops what it would have inherited of the other.
void read_rate_dependence(ObjectReader& in, MaterialInput& m) {
  in.number("viscosity_Pa_s", m.eta, {"Pa s", 0.0, 1e9},
            {"Viscosity once the soil has yielded; not together with mu_i.",
             "back-analysis or rheometer, talus validate lists values by soil type; [Z20] Eq. 4"});
  in.exclude("mu_i", "viscosity_Pa_s");
  in.object("mu_i",
            "Friction that grows with the shear rate instead of a viscosity: mu(I) = mu_s + (mu_2 - mu_s) I/(I_0 + I), "
            "I = shear rate x grain diameter / sqrt(pressure / grain density).",
            Absent::skip, [&](ObjectReader& section) { read_inertial_friction(section, m); });
  const bool own = in.find("mu_i") != nullptr;
  if (!own && in.find("viscosity_Pa_s") != nullptr) m.mu_i.reset();
  if (!m.mu_i) return;
  m.eta = 0.0;
  in.remove_record("viscosity_Pa_s");
  m.mu_i->delta_mu = std::tan(radians(m.high_rate_friction_angle_deg)) - std::tan(m.phi);
  if (m.mu_i->delta_mu > 0.0) return;
  if (own)
    in.faults().add(pointer_to(in.pointer("mu_i"), "high_rate_friction_angle_deg"),
                    to_text(m.high_rate_friction_angle_deg) + " does not exceed friction_angle_deg, " +
                        to_text(m.friction_angle_deg) + "; friction grows with the shear rate");
  else
    in.fault("friction_angle_deg", to_text(m.friction_angle_deg) +
                                       " is not less than high_rate_friction_angle_deg of the default material's "
                                       "mu_i, " +
                                       to_text(m.high_rate_friction_angle_deg) + "; give this layer a mu_i of its own");
}

/// The leapfrog gives the fronts of rk2 in half the time, but with a Shepard filter, without any, or with the
/// regularised law soil at rest shakes with it at the usual step.
Integrator default_integrator(const Numerics& n, Yield yield, bool fixed_step) {
  const bool calm = yield == Yield::elastic && n.density_filter == DensityFilter::delta_sph;
  const bool stable = !fixed_step && n.cfl <= stable_cfl(Integrator::leapfrog);
  return calm && stable ? Integrator::leapfrog : Integrator::rk2;
}

}  // namespace

void read_material(ObjectReader& in, MaterialInput& m) {
  in.string("name", m.name, {1, 100}, {"Name of the material in messages and results."});
  in.number_in_either("density_kg_m3", m.rho0, {"kg/m3", 1.0, 1e5},
                      {"Reference density of the soil in place.", "laboratory; [Z20] Eq. 3",
                       "none, required unless unit_weight_kN_m3 is given"},
                      true,
                      {"unit_weight_kN_m3",
                       {"kN/m3", 0.00981, 981.0},
                       1000.0 / laboratory_gravity,
                       {"Unit weight of the soil in place, instead of its density: divided by 9.81 m/s2, whatever "
                        "gravity_m_s2 is.",
                        "laboratory", "none"}});
  read_strength(in, m);
  read_rate_dependence(in, m);
  read_softening(in, m);
}

void read_rheology(ObjectReader& in, Rheology& r) {
  in.choice("shear_rate", r.shear_rate, shear_rates,
            {"Equivalent shear rate: consistent sqrt(2 dev:dev), with which simple shear gives [Z20] Eq. 5; paper "
             "sqrt(2/3 dev:dev), Eq. 7 as printed, which makes the soil stronger.",
             "[Z20] Eqs. 5, 7"});
  in.choice("yield", r.yield, yields,
            {"elastic: elasto-viscoplastic stress with an exact yield limit, which comes to rest; regularized: "
             "equivalent viscosity, which creeps.",
             "[Z20] Eq. 6 for regularized"});
  in.number("min_shear_rate_1_s", r.gamma_dot_min, {"1/s", 0.0, 1000.0, true},
            {"Smallest shear rate in the regularized law.", "[Z20] section 2"});
  in.optional_number("shear_modulus_Pa", r.G, {"Pa", 0.0, 1e15, true},
                     {"Numerical shear modulus of the elastic law.", "numerical", "0.3 density sound_speed^2"});
}

void read_numerics(ObjectReader& in, Numerics& n, Yield yield, bool fixed_step) {
  in.choice("kernel", n.kernel, kernels, {"Smoothing kernel.", "Monaghan & Lattanzio 1985; Wendland 1995"});
  in.number("smoothing_ratio", n.h_over_dx, {"", 1.0, 2.0},
            {"Smoothing length over particle spacing, h/dx.",
             "numerical noise of the front, see tests/validation; [Z20] does not state it"});
  in.optional_number("sound_speed_m_s", n.c_s, {"m/s", 0.1, 1e5},
                     {"Numerical speed of sound of the equation of state.", "Monaghan 1994: density then varies by 1 %",
                      "10 sqrt(2 g H), H from the slide's highest point to the lowest of the bed within its reach"});
  in.number("artificial_viscosity_alpha", n.alpha, {"", 0.0, 10.0},
            {"Artificial viscosity, linear term.", "Monaghan 1992"});
  in.number("artificial_viscosity_beta", n.beta, {"", 0.0, 10.0},
            {"Artificial viscosity, quadratic term.", "Monaghan 1992"});
  in.choice(
      "artificial_viscosity_jump", n.velocity_jump, jumps,
      {"What the artificial viscosity acts on: reconstructed: what of the relative velocity of two particles their "
       "velocity gradients do not explain, so that smooth shear is left alone; whole: all of it, where they approach.",
       "Frontiere et al. 2017; Monaghan 1992 for whole"});
  in.choice("continuity", n.continuity, continuities,
            {"volume: density rate rho_i sum V_j, exact across jumps of density; mass: sum m_j as printed.",
             "[Z20] Eq. 1 for mass"});
  in.choice("density_filter", n.density_filter, filters,
            {"Density regularisation: delta-SPH diffusion, Shepard filter every filter_interval_steps, or none.",
             "Fourtakas et al. 2019 for delta_sph; [Z20] section 2 for shepard"});
  in.integer("filter_interval_steps", n.filter_interval, {"steps", 1.0, 1e6},
             {"Steps between two Shepard filters.", "common SPH practice"});
  in.number("delta_sph_coefficient", n.delta, {"", 0.0, 1.0},
            {"Coefficient of the delta-SPH diffusion.", "Antuono et al. 2010"});
  in.flag("tension_cutoff", n.tension_cutoff,
          {"Negative pressure is cut to zero: loose soil carries no tension.", "soil mechanics"});
  in.choice("initial_pressure", n.initial_pressure, initial_pressures,
            {"hydrostatic: from the weight of the soil above; stress_free: none.", "[Z20] Eq. 10, its p0"});
  in.number("cfl", n.cfl, {"", 0.0, 1.0, true},
            {"Courant number of the time step when fixed_step_s is not given.",
             "Monaghan 1992; limits: stability measured on slopes", "", "> 0 and <= 0.8, <= 0.4 with leapfrog"});
  n.integrator = default_integrator(n, yield, fixed_step);
  in.choice("integrator", n.integrator, integrators,
            {"leapfrog: symplectic, 1 evaluation a step; rk2: midpoint, 2 evaluations.", "[Z20] section 2 for rk2",
             "leapfrog with the elastic law, delta_sph and a step that follows a cfl of at most 0.4, otherwise rk2"});
  in.choice(
      "precision", n.precision, precisions,
      {"Precision of the sums over soil pairs: single runs vectorised, double runs the plain reference loops; the "
       "state is double in both.",
       "this program"});
  in.limit_by_choice("cfl", n.cfl, "integrator",
                     {{"rk2", stable_cfl(Integrator::rk2)}, {"leapfrog", stable_cfl(Integrator::leapfrog)}},
                     "measured on slopes, the deposit begins to shake a little above");
}

void read_time(ObjectReader& in, TimeControl& t) {
  in.required_number("end_s", t.end, {"s", 1e-9, 1e7}, {"Simulated time at which the run ends."});
  in.optional_number(
      "fixed_step_s", t.fixed_step, duration,
      {"Constant time step; not together with max_step_s.", "[Z20] Table 3 uses 3e-4", "none, the step follows cfl"});
  in.optional_number("max_step_s", t.max_step, duration, {"Upper bound of the Courant step.", "user", "none"});
  in.exclude("max_step_s", "fixed_step_s");
  read_snapshots(in, t);
  StopAtRest stop;
  const bool stops = in.switchable(
      "stop_at_rest", {"End early once the slide rests: false, true for the default rule, or the rule itself."},
      [&](ObjectReader& rule) {
        rule.number("speed_m_s", stop.speed, {"m/s", 0.0, 1000.0, true},
                    {"Root-mean-square speed below which the slide rests."});
        rule.number("hold_s", stop.hold, {"s", 0.0, 1e6}, {"For how long the speed must stay below."});
      });
  if (stops) t.stop_at_rest = stop;
  in.record("snapshot_times_s", t.snapshots);
}

}  // namespace talus
