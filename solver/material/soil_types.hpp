#pragma once
// What measurements and back-analyses give for the rate dependence and the strength of types of soil. `talus validate`
// proposes it, and README.md prints it.

#include <array>

namespace talus {

/// The rate dependence of a type of soil: a viscosity, or the rise of mu(I) friction over tan(phi).
struct SoilType {
  const char* name;
  double eta;                ///< viscosity once it has yielded [Pa s]; 0: mu(I) friction instead
  double eta_low, eta_high;  ///< range of the source [Pa s]
  double delta_mu;           ///< mu_2 - mu_s [-]
  double I_0;                ///< inertial number of half the rise [-]
  const char* source;
};

constexpr SoilType viscous(const char* name, double eta, double low, double high, const char* source) {
  return {name, eta, low, high, 0.0, 0.0, source};
}
constexpr SoilType granular(const char* name, double delta_mu, double I_0, const char* source) {
  return {name, 0.0, 0.0, 0.0, delta_mu, I_0, source};
}

/// Field values, where there are any: viscosities measured on the fine fraction in the laboratory are another
/// population and do not represent the field (Prochaska et al. 2008, Landslides, doi:10.1007/s10346-008-0137-0).
inline constexpr std::array soil_types{
    viscous(
        "slope debris, colluvium, weathered cover soil", 1500.0, 800.0, 3000.0,
        "Kameda & Okamoto 2021, Earth Planets Space 73, doi:10.1186/s40623-021-01443-y: back-analysis of a slide 80 m "
        "long and 7 m thick in volcanic cover soil"),
    viscous("soft clay, not remoulded", 1000.0, 300.0, 3000.0,
            "estimate: undrained strength rises by about 10 % per tenfold strain rate (Kulhawy & Mayne 1990, EPRI "
            "EL-6800), here from 1e-5 to 1 1/s at 0.6 to 6 kPa"),
    viscous("loose fill or spoil that flows", 958.0, 958.0, 958.0,
            "Jeyapalan, Duncan & Seed 1983, J. Geotech. Eng. 109(2), 172-189: back-analysis of the Aberfan flow slide"),
    viscous("saturated debris, debris flow", 500.0, 200.0, 6000.0,
            "Sharp & Nobles 1953, GSA Bulletin 64, 547-560: 200 to 600 Pa s in the field; Phillips & Davies 1991, "
            "Geomorphology 4, 101-110: up to 6000 Pa s in a large rheometer"),
    viscous("liquefied fine tailings", 50.0, 50.0, 50.0,
            "Jeyapalan, Duncan & Seed 1983, J. Geotech. Eng. 109(2), 172-189: gypsum tailings"),
    viscous("remoulded sensitive clay", 0.2, 0.007, 0.2,
            "Locat & Demers 1988, Can. Geotech. J. 25, 799-806: liquidity index 5 to 2, laboratory"),
    granular(
        "dry sand, gravel, broken rock", 0.26, 0.279,
        "Jop, Forterre & Pouliquen 2006, Nature 441, 727-730: glass beads of 0.53 mm; grain diameter from the site"),
};

/// A range of a key of material, for a type of soil.
struct StrengthValue {
  const char* soil;
  const char* key;   ///< of material, or of material.softening
  double low, high;  ///< in the unit of the key
  const char* source;
};

/// Of pore pressure: gamma_w cos^2(beta)/gamma with gamma = 20 kN/m3 and slopes of 30 and 0 degrees.
inline constexpr std::array strength_values{
    StrengthValue{"slope with its water table at the ground, flow parallel to it", "r_u", 0.37, 0.49,
                  "gamma_w cos^2(beta)/gamma of the infinite slope (Skempton & DeLory 1957, Proc. 4th ICSMFE 2, "
                  "378-381), gamma = 20 kN/m3, 30 to 0 degrees"},
    StrengthValue{"slope with its water table at half the thickness", "r_u", 0.18, 0.25, "half of that"},
    StrengthValue{"clay of low strength", "undrained_strength_kPa", 20.0, 40.0, "EN ISO 14688-2:2018"},
    StrengthValue{"clay of medium strength", "undrained_strength_kPa", 40.0, 75.0, "EN ISO 14688-2:2018"},
    StrengthValue{"clay of high strength", "undrained_strength_kPa", 75.0, 150.0, "EN ISO 14688-2:2018"},
    StrengthValue{"normally consolidated clay below the water table", "undrained_strength_gradient_kPa_per_m", 1.0, 2.0,
                  "0.22 of the vertical effective stress (Mesri 1975, J. Geotech. Eng. Div. 101(4), 409-412) at a "
                  "buoyant unit weight of 5 to 9 kN/m3"},
    StrengthValue{"soil with a clay fraction below 25 %", "residual_friction_angle_deg", 20.0, 35.0,
                  "Skempton 1985, Geotechnique 35, 3-18: typically above 20 degrees, as sand or silt"},
    StrengthValue{"clay of more than 50 % kaolinite", "residual_friction_angle_deg", 15.0, 15.0, "Skempton 1985"},
    StrengthValue{"clay of more than 50 % illite", "residual_friction_angle_deg", 10.0, 10.0, "Skempton 1985"},
    StrengthValue{"clay of more than 50 % montmorillonite", "residual_friction_angle_deg", 5.0, 5.0, "Skempton 1985"},
};

}  // namespace talus
