#include "simulation/strength_loss.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "material/constitutive_models-inl.hpp"
#include "material/pore_pressure.hpp"
#include "material/softening.hpp"
#include "simulation/gaussian_average.hpp"

namespace talus {
namespace {

constexpr std::int64_t averaging_interval = 10;  ///< steps; in so many no band shears by much

/// Where a material does not soften: 0.
double strain_to_residual(const Material& m, double dx) {
  if (!m.softening) return 0.0;
  const Softening& s = *m.softening;
  return s.shear_strain ? *s.shear_strain : residual_strain(*s.displacement, shear_band_width(s, dx));
}

/// Of the average that makes bands as wide as stated; 0 where they are no wider than the spacing resolves. [m]
double sigma_of(const Material& m, double dx) {
  if (!m.softening || !m.softening->band_width || *m.softening->band_width <= shear_band_spacings * dx) return 0.0;
  return *m.softening->band_width / std::sqrt(2.0 * std::numbers::pi);
}

/// Plastic shear strain of the return to the yield surface that the evaluation `ahead` will make.
double coming_increment(const Flow& flow, const Soil& soil, std::size_t i, double ahead) {
  using namespace HWY_NAMESPACE;
  const FlowConstants& k = flow.constants();
  const ConstitutiveParameters& of = k.soils[static_cast<std::size_t>(soil.material[i])];
  const ElasticRates rates = flow.elastic_rates(soil, i);
  const Deviator<double> t{soil.txx[i] + ahead * rates.dtxx, soil.tyy[i] + ahead * rates.dtyy,
                           soil.txy[i] + ahead * rates.dtxy};
  double p = pressure(of.eos.B, (soil.rho[i] + ahead * rates.drho) / of.eos.rho0 - 1.0);
  if (k.numerics.tension_cutoff) p = apply_tension_cutoff(p);
  const double limit = yield_factor(k.rheology.shear_rate) * yield_stress(soil.c[i], soil.tan_phi[i], p);
  return plastic_increment(magnitude(t), limit, of.G);
}

}  // namespace

StrengthLoss::StrengthLoss(const Model& model, const FlowConstants& k, const Soil& soil,
                           const std::vector<double>& lambda) {
  if (std::ranges::none_of(model.materials, [](const Material& m) { return m.softening.has_value(); })) return;
  for (const Material& m : model.materials) {
    residual_strain_.push_back(strain_to_residual(m, k.dx));
    sigma_.push_back(sigma_of(m, k.dx));
  }
  strain_.assign(soil.size(), 0.0);
  pending_.assign(soil.size(), 0.0);
  for (std::size_t i = 0; i < soil.size(); ++i) {
    const std::optional<Softening>& softening = model.materials[static_cast<std::size_t>(soil.material[i])].softening;
    Range range{soil.c[i], soil.c[i], soil.tan_phi[i], soil.tan_phi[i]};
    if (softening && softening->c) range.c_residual = *softening->c;
    if (softening && softening->phi)
      range.tan_phi_residual = total_stress_friction(std::tan(*softening->phi), lambda.empty() ? 0.0 : lambda[i]);
    strength_.push_back(range);
  }
}

bool StrengthLoss::act(const Flow& flow, Soil& soil, double ahead, std::int64_t steps) {
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < soil.n_active; ++i) {
    const auto material = static_cast<std::size_t>(soil.material[i]), id = static_cast<std::size_t>(soil.id[i]);
    if (residual_strain_[material] == 0.0) continue;
    const double increment = coming_increment(flow, soil, i, ahead);
    (sigma_[material] > 0.0 ? pending_ : strain_)[id] += increment;
  }
  if (steps % averaging_interval == 0) average_pending(soil);
  return soften(soil);
}

/// Moves what is pending of each material to the strains, averaged over the particles of the material.
void StrengthLoss::average_pending(const Soil& soil) {
  for (std::size_t material = 0; material < sigma_.size(); ++material) {
    if (sigma_[material] == 0.0) continue;
    std::vector<double> x, y, m, value;
    std::vector<std::size_t> ids;
    for (std::size_t i = 0; i < soil.n_active; ++i) {
      if (static_cast<std::size_t>(soil.material[i]) != material) continue;
      x.push_back(soil.x[i]);
      y.push_back(soil.y[i]);
      m.push_back(soil.m[i]);
      ids.push_back(static_cast<std::size_t>(soil.id[i]));
      value.push_back(pending_[ids.back()]);
    }
    if (std::ranges::all_of(value, [](double v) { return v == 0.0; })) continue;
    const std::vector<double> average = gaussian_average(x, y, m, value, sigma_[material]);
    for (std::size_t k = 0; k < ids.size(); ++k) {
      strain_[ids[k]] += average[k];
      pending_[ids[k]] = 0.0;
    }
  }
}

/// Strength of all active soil by its strain. @return whether any has changed
bool StrengthLoss::soften(Soil& soil) {
  bool changed = false;
#pragma omp parallel for schedule(static) reduction(|| : changed)
  for (std::size_t i = 0; i < soil.n_active; ++i) {
    const double gamma_r = residual_strain_[static_cast<std::size_t>(soil.material[i])];
    const auto id = static_cast<std::size_t>(soil.id[i]);
    if (gamma_r == 0.0 || strain_[id] == 0.0) continue;
    const double share = softened_share(strain_[id], gamma_r);
    const Range& range = strength_[id];
    const double c = softened(range.c_peak, range.c_residual, share),
                 tan_phi = softened(range.tan_phi_peak, range.tan_phi_residual, share);
    changed = changed || c != soil.c[i] || tan_phi != soil.tan_phi[i];
    soil.c[i] = c;
    soil.tan_phi[i] = tan_phi;
  }
  return changed;
}

double shear_band_width(const Softening& softening, double dx) {
  return std::max(softening.band_width.value_or(0.0), shear_band_spacings * dx);
}

}  // namespace talus
