// Values that are allowed but that no soil has: mostly slips of the unit.

#include <algorithm>

#include "case/sections.hpp"
#include "math/angle.hpp"
#include "random_field/property_laws.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

/// Values of a quantity that were probably meant in another unit.
struct Slip {
  double lo, hi;       ///< range of the slip, both included
  const char* advice;  ///< what was probably meant, and what to type
};

/// A quantity and what its values usually are.
struct Usual {
  const char* key;
  const char* unit;
  double lo, hi;  ///< usual range, both included
  const char* range;
  std::vector<Slip> slips;
};

const Usual density{"density_kg_m3",
                    "kg/m3",
                    500.0,
                    5000.0,
                    "500 to 5000 kg/m3",
                    {{5.0, 50.0, "a unit weight in kN/m3 is given as unit_weight_kN_m3"},
                     {0.5, 5.0, "a density in t/m3 or g/cm3 is multiplied by 1000"}}};
const Usual cohesion{"cohesion_Pa",
                     "Pa",
                     50.0,
                     5e6,
                     "0, or 50 Pa to 5 MPa",
                     {{0.0, 50.0, "a cohesion in kPa is given as cohesion_kPa"}}};
const Usual wall_cohesion{
    "cohesion_Pa", "Pa", 50.0, 5e6, "0, or 50 Pa to 5 MPa", {{0.0, 50.0, "a cohesion in kPa is multiplied by 1000"}}};
const Usual friction_angle{"friction_angle_deg",
                           "deg",
                           2.0,
                           60.0,
                           "0, or 2 to 60 deg",
                           {{0.0, 2.0, "a value in radians, or tan(phi), is converted to degrees"}}};
const Usual viscosity{"viscosity_Pa_s", "Pa s", 0.0, 1e6, "up to 1e6 Pa s", {}};
const Usual undrained_strength{"undrained_strength_Pa",
                               "Pa",
                               200.0,
                               2e6,
                               "0, or 200 Pa to 2 MPa",
                               {{0.0, 200.0, "a strength in kPa is given as undrained_strength_kPa"}}};
const Usual strength_gradient{"undrained_strength_gradient_kPa_per_m",
                              "kPa/m",
                              0.1,
                              20.0,
                              "0, or 0.1 to 20 kPa/m",
                              {{100.0, 1000.0, "a gradient in Pa/m is divided by 1000"}}};
const Usual pore_pressure_ratio_usual{
    "r_u", "", 0.02, 0.7, "0, or 0.02 to 0.7", {{0.7, 1.0, "at 1 the soil is liquefied; a ratio, not a percentage"}}};
const Usual softening_displacement{
    "displacement_m", "m", 1e-3, 5.0, "1 mm to 5 m", {{5.0, 1000.0, "a displacement in mm is divided by 1000"}}};
const Usual residual_cohesion{"residual_cohesion_Pa",
                              "Pa",
                              20.0,
                              5e6,
                              "0, or 20 Pa to 5 MPa",
                              {{0.0, 20.0, "a cohesion in kPa is given as residual_cohesion_kPa"}}};
const Usual residual_strength{"residual_undrained_strength_Pa",
                              "Pa",
                              20.0,
                              2e6,
                              "0, or 20 Pa to 2 MPa",
                              {{0.0, 20.0, "a strength in kPa is given as residual_undrained_strength_kPa"}}};
const Usual turbulence{"voellmy_xi_m_s2", "m/s2", 20.0, 1e4, "20 to 10000 m/s2", {}};
const Usual grain_diameter{"grain_diameter_m",
                           "m",
                           1e-6,
                           0.5,
                           "0.001 mm to 0.5 m",
                           {{0.5, 10.0, "a diameter in mm is given as grain_diameter_mm"}}};
const Usual grain_density{"grain_density_kg_m3", "kg/m3", 1000.0, 8000.0, "1000 to 8000 kg/m3", {}};
const Usual shear_modulus{"shear_modulus_Pa",
                          "Pa",
                          1e4,
                          1e11,
                          "10 kPa to 100 GPa",
                          {{0.0, 1e4, "a modulus in kPa or MPa is multiplied by 1000 or 1e6"}}};

bool is_usual(const Usual& usual, double value) { return value == 0.0 || (value >= usual.lo && value <= usual.hi); }

void warn(const Usual& usual, double value, const std::string& section, std::vector<Fault>& warnings) {
  if (is_usual(usual, value)) return;
  const std::string unit = *usual.unit == '\0' ? "" : std::string(" ") + usual.unit;
  std::string message = to_text(value) + unit + " is unusual for soil (" + usual.range + ")";
  for (const Slip& slip : usual.slips)
    if (value >= slip.lo && value <= slip.hi) {
      message += "; " + std::string(slip.advice);
      break;
    }
  warnings.push_back({section + "/" + usual.key, message});
}

void warn_of_softening(const Softening& s, bool undrained, const std::string& section, std::vector<Fault>& warnings) {
  if (s.phi) {
    Usual angle = friction_angle;
    angle.key = "residual_friction_angle_deg";
    warn(angle, degrees(*s.phi), section, warnings);
  }
  if (s.c) warn(undrained ? residual_strength : residual_cohesion, *s.c, section, warnings);
  if (s.displacement) warn(softening_displacement, *s.displacement, section, warnings);
  if (s.shear_strain)
    warnings.push_back({section + "/plastic_shear_strain",
                        "makes the run-out depend on the particle spacing; displacement_m does not"});
}

void warn_of_walls(const Boundary& b, std::vector<Fault>& warnings) {
  if (b.c) warn(wall_cohesion, *b.c, "/walls", warnings);
  if (b.xi) warn(turbulence, *b.xi, "/walls", warnings);
  for (std::size_t k = 0; k < b.stretches.size(); ++k) {
    const std::string section = "/walls/stretches/" + std::to_string(k);
    warn(friction_angle, degrees(b.stretches[k].phi), section, warnings);
    if (b.stretches[k].c) warn(cohesion, *b.stretches[k].c, section, warnings);
    if (b.stretches[k].xi) warn(turbulence, *b.stretches[k].xi, section, warnings);
  }
}

/// The stated mean of a random property.
void warn_of_mean(const PropertySpec& p, std::vector<Fault>& warnings) {
  if (!p.mean) return;
  const bool angle = p.property == Property::friction;
  const Usual* const usual[] = {&friction_angle, &cohesion, &density, &viscosity};
  const Usual& of = *usual[index_of(p.property)];
  const double value = angle ? friction_angle_deg(*p.mean) : *p.mean;
  if (!is_usual(of, value))
    warnings.push_back({property_pointer(p.property),
                        "a mean of " + rounded(value) + " " + of.unit + " is unusual for soil (" + of.range + ")"});
}

}  // namespace

std::string material_pointer(const Model& model, std::size_t material) {
  const auto part = std::ranges::find(model.slide, static_cast<int>(material), &SlidePart::material);
  return material == 0 ? "/material" : "/slide/outlines/" + std::to_string(part - model.slide.begin()) + "/material";
}

void warn_of_unlikely_values(const Case& c, std::vector<Fault>& warnings) {
  const Model& model = c.model;
  for (std::size_t k = 0; k < model.materials.size(); ++k) {
    const Material& m = model.materials[k];
    const Material& base = model.materials.front();  // a layer that inherits a value is not warned of it again
    const std::string section = material_pointer(model, k);
    if (k == 0 || m.rho0 != base.rho0) warn(density, m.rho0, section, warnings);
    if (k == 0 || m.phi != base.phi) warn(friction_angle, degrees(m.phi), section, warnings);
    if (k == 0 || m.c != base.c) warn(m.undrained ? undrained_strength : cohesion, m.c, section, warnings);
    if (k == 0 || m.c_gradient != base.c_gradient) warn(strength_gradient, m.c_gradient / 1000.0, section, warnings);
    if (m.r_u && (k == 0 || m.r_u != base.r_u)) warn(pore_pressure_ratio_usual, *m.r_u, section, warnings);
    if (m.softening && (k == 0 || m.softening != base.softening))
      warn_of_softening(*m.softening, m.undrained, section + "/softening", warnings);
    if (k == 0 || m.eta != base.eta) warn(viscosity, m.eta, section, warnings);
    if (m.mu_i && (k == 0 || m.mu_i != base.mu_i)) {
      warn(grain_diameter, m.mu_i->d, section + "/mu_i", warnings);
      warn(grain_density, m.mu_i->rho_s, section + "/mu_i", warnings);
    }
  }
  for (const Boundary& b : model.boundaries) warn_of_walls(b, warnings);
  if (c.field)
    for (const PropertySpec& p : c.field->properties) warn_of_mean(p, warnings);
  if (model.rheology.G) warn(shear_modulus, *model.rheology.G, "/rheology", warnings);
}

}  // namespace talus
