#include "simulation/energy_account.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "material/equation_of_state.hpp"
#include "sph/continuity-inl.hpp"

namespace talus {
namespace {

constexpr std::array power_terms{&Powers::deviator, &Powers::viscosity, &Powers::artificial_viscosity,
                                 &Powers::density_diffusion, &Powers::boundaries};

const ConstitutiveParameters& parameters(const FlowConstants& k, const Soil& soil, std::size_t i) {
  return k.soils[static_cast<std::size_t>(soil.material[i])];
}

/// Elastic energy of the volume of one particle [J/m]; none in tension where the pressure is cut off.
double compression_of(const FlowConstants& k, const Soil& soil, std::size_t i) {
  const EquationOfState eos = equation_of_state(k, soil, i);
  const bool cut = k.numerics.tension_cutoff && soil.rho[i] < eos.rho0;
  return cut ? 0.0 : soil.m[i] * eos.energy(soil.rho[i]);
}

/// V t:t/(4 G), t the elastic deviatoric stress, V the volume that the pair sums use [J/m].
double distortion_of(const FlowConstants& k, const Soil& soil, std::size_t i) {
  using namespace HWY_NAMESPACE;
  const ConstitutiveParameters& of = parameters(k, soil, i);
  const Deviator<double> t{soil.txx[i], soil.tyy[i], soil.txy[i]};
  const double V = soil.m[i] / pair_density(soil.rho[i], least_density(reference_density(k, soil, i)));
  return V * double_dot(t) / (4.0 * of.G);
}

double kinetic_of(const Soil& soil, std::size_t i) { return 0.5 * soil.m[i] * norm2(soil.velocity(i)); }

}  // namespace

double compression_energy(const FlowConstants& k, const Soil& soil) {
  double sum = 0.0;
  for (std::size_t i = 0; i < soil.n_active; ++i) sum += compression_of(k, soil, i);
  return sum;
}

/// A measurement costs some 6 % of a step. In a small model a few impacts are a part of the whole, and last a few
/// steps.
EnergyAccount::EnergyAccount(const FlowConstants& k, const Soil& soil)
    : stored_at_start_(compression_energy(k, soil)), interval_(soil.size() < 500 ? 1.0 : 4.0 + std::numbers::phi) {}

/// The steps floor(n interval): with an interval that is not rational they keep no pace with anything that happens
/// every so many steps, such as a density filter, after which the pressure rings.
bool EnergyAccount::due(std::int64_t steps) const {
  const auto at = [this](double n) { return static_cast<std::int64_t>(n * interval_); };
  return at(std::ceil(static_cast<double>(steps) / interval_)) == steps;
}

void EnergyAccount::measure(const Powers& powers, double time) {
  if (!measured_) last_ = powers;
  const double half = 0.5 * (time - measured_at_);
  for (const auto term : power_terms) work_.*term += half * (last_.*term + powers.*term);
  last_ = powers;
  measured_at_ = time;
  measured_ = true;
}

EnergyBudget EnergyAccount::budget(const FlowConstants& k, const Soil& soil, const StartingPositions& starts,
                                   double time, double taken_by_contact) const {
  EnergyBudget e;
  double departed_distortion = 0.0;
  for (std::size_t i = 0; i < soil.size(); ++i) {
    e.potential -= soil.m[i] * dot(k.g, soil.position(i) - starts[soil.id[i]]);
    if (i < soil.n_active) {
      e.kinetic += kinetic_of(soil, i);
      e.compression += compression_of(k, soil, i);
      e.distortion += distortion_of(k, soil, i);
    } else {
      e.departed += kinetic_of(soil, i) + compression_of(k, soil, i);
      departed_distortion += distortion_of(k, soil, i);
    }
  }
  e.departed += departed_distortion;
  Powers work = work_;
  for (const auto term : power_terms) work.*term += (time - measured_at_) * last_.*term;
  e.friction = work.deviator - e.distortion - departed_distortion;
  e.viscosity = work.viscosity;
  e.artificial_viscosity = work.artificial_viscosity;
  e.density_diffusion = work.density_diffusion;
  e.boundaries = work.boundaries;
  e.contact = taken_by_contact;
  e.stored_at_start = stored_at_start_;
  return e;
}

std::vector<double> EnergyAccount::state() const {
  std::vector<double> state{measured_at_, measured_ ? 1.0 : 0.0};
  for (const auto term : power_terms) {
    state.push_back(work_.*term);
    state.push_back(last_.*term);
  }
  return state;
}

void EnergyAccount::restore(const std::vector<double>& state) {
  measured_at_ = state[0];
  measured_ = state[1] != 0.0;
  auto value = state.begin() + 2;
  for (const auto term : power_terms) {
    work_.*term = *value++;
    last_.*term = *value++;
  }
}

}  // namespace talus
