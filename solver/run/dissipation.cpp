#include "run/dissipation.hpp"

#include <algorithm>

#include "simulation/particle_setup.hpp"
#include "simulation/reach.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

/// Soil rather than a fluid.
bool has_strength(const Material& m) { return m.phi > 0.0 || m.c > 0.0; }

bool lacks_rate_dependence(const Material& m) { return has_strength(m) && m.eta == 0.0 && !m.mu_i; }

/// Three significant digits without an exponent [Pa s].
std::string viscosity_text(double eta) { return to_text(*to_number(rounded(eta))); }

/// The rate dependence as stated, whatever the friction angle: mu_2 - mu_s follows from both.
bool same_rate_dependence(Material a, const Material& b) {
  if (a.mu_i && b.mu_i) a.mu_i->delta_mu = b.mu_i->delta_mu;
  return a.eta == b.eta && a.mu_i == b.mu_i;
}

void warn_of_large_grains(const Material& m, const std::string& section, double dx, std::vector<Fault>& warnings) {
  if (!m.mu_i || m.mu_i->d <= dx) return;
  warnings.push_back({section + "/mu_i/grain_diameter_m",
                      "grains of " + rounded(m.mu_i->d) + " m are larger than the particle spacing of " + rounded(dx) +
                          " m: mu(I) describes soil of many grains a particle"});
}

/// What the artificial viscosity of reconstructed velocities still takes, as a share of the shear viscosity that
/// Monaghan's term stands for: 0.10 and 0.14 on the illustrative slope at 0.2 and 0.1 m, by the energy that it and the
/// stated viscosity take.
constexpr double left_by_reconstruction = 0.1;

/// @param p  the largest pressure at rest [Pa]
void warn_of_numerical_viscosity(const Model& model, const Material& m, const std::string& section, double p,
                                 std::vector<Fault>& warnings) {
  const bool whole = model.numerics.velocity_jump == VelocityJump::whole;
  if (!whole && m.mu_i) return;  // small grains depend little on the rate
  const double numerical = artificial_shear_viscosity(flow_constants(model), m.rho0),
               acting = whole ? numerical : left_by_reconstruction * numerical;
  const double stated = m.mu_i ? largest_viscosity(*m.mu_i, p) : m.eta;
  if (!has_strength(m) || stated == 0.0 || stated >= acting) return;
  const std::string is = m.mu_i ? "stands for at most " : "is ";
  const std::string advice = whole ? "set numerics.artificial_viscosity_jump to reconstructed"
                                   : "it falls with the spacing; talus validate lists values by soil type";
  warnings.push_back({section + (m.mu_i ? "/mu_i" : "/viscosity_Pa_s"),
                      is + viscosity_text(stated) + " Pa s, less than the artificial viscosity, which acts as about " +
                          viscosity_text(acting) + " Pa s at this particle spacing and decides the run-out; " +
                          advice});
}

}  // namespace

bool lacks_rate_dependence(const Model& model) {
  return model.rheology.yield == Yield::elastic &&
         std::ranges::any_of(model.materials, [](const Material& m) { return lacks_rate_dependence(m); });
}

std::vector<Fault> dissipation_warnings(const Model& model) {
  std::vector<Fault> warnings;
  const double depth = fall_height(model);  // no soil is thicker
  for (std::size_t k = 0; k < model.materials.size(); ++k) {
    const Material &m = model.materials[k], &base = model.materials.front();
    if (k > 0 && has_strength(base) && same_rate_dependence(m, base)) continue;  // a layer inherits the warnings too
    const std::string section = material_pointer(model, k);
    if (model.rheology.yield == Yield::elastic && lacks_rate_dependence(m))
      warnings.push_back({section,
                          "no rate-dependent dissipation is stated (viscosity_Pa_s or mu_i): the run-out then depends "
                          "on the numerical dissipation, which falls with the spacing; talus validate lists values by "
                          "soil type"});
    warn_of_large_grains(m, section, model.dx, warnings);
    warn_of_numerical_viscosity(model, m, section, m.rho0 * norm(model.g) * depth, warnings);
  }
  return warnings;
}

}  // namespace talus
