// The warnings about rate dependence, on both sides of each limit, and the table of soil types.

#include <gtest/gtest.h>

#include <string_view>

#include "material/soil_types.hpp"
#include "run/dissipation.hpp"
#include "run/warnings.hpp"

namespace talus {
namespace {

/// A slope of two soils; `changes` are overrides.
Case two_soils(std::vector<std::string> changes) {
  const Json document = {
      {"title", "two soils"},
      {"particle_spacing_m", 0.5},
      {"terrain", {{"bed_m", {{0, 4}, {8, 0}, {60, 0}}}}},
      {"slide",
       {{"outlines",
         {{{"outline_m", {{0, 4}, {4, 2}, {4, 5}, {0, 7}}}},
          {{"outline_m", {{4, 2}, {8, 0}, {10, 0}, {4, 5}}}, {"material", {{"friction_angle_deg", 20}}}}}}}},
      {"material", {{"density_kg_m3", 2000}, {"friction_angle_deg", 25}}},
      {"numerics", {{"sound_speed_m_s", 100}}},
      {"time", {{"end_s", 3}}}};
  return load_case(document, "", changes).value;
}

std::vector<Fault> warnings_of(const std::vector<std::string>& changes) {
  return dissipation_warnings(two_soils(changes).model);
}
std::string pointers_of(const std::vector<std::string>& changes) {
  std::string all;
  for (const Fault& warning : warnings_of(changes)) all += warning.pointer + " ";
  return all;
}
bool lacking(const std::vector<std::string>& changes) { return lacks_rate_dependence(two_soils(changes).model); }

TEST(Dissipation, SoilThatStatesNoneIsWarnedOfOnce) {
  EXPECT_TRUE(lacking({}));
  EXPECT_EQ(pointers_of({}), "/material ");
  EXPECT_NE(warnings_of({}).at(0).message.find("which falls with the spacing; talus validate"), std::string::npos);
  const std::vector<Fault> all = warnings_before_run(two_soils({}));
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].pointer, "/material");
}

TEST(Dissipation, ALayerOfItsOwnIsNamed) {
  const std::string base = "material.viscosity_Pa_s=5000", layer = "slide.outlines.1.material.viscosity_Pa_s=";
  EXPECT_EQ(pointers_of({base}), "");
  EXPECT_FALSE(lacking({base}));
  EXPECT_EQ(pointers_of({base, layer + "0"}), "/slide/outlines/1/material ");
  EXPECT_TRUE(lacking({base, layer + "0"}));
  EXPECT_EQ(pointers_of({layer + "5000"}), "/material ");
}

TEST(Dissipation, FluidsAndTheRegularizedLawAreLeftAlone) {
  const std::vector<std::string> fluid{"material.friction_angle_deg=0",
                                       "slide.outlines.1.material.friction_angle_deg=0"};
  EXPECT_EQ(pointers_of(fluid), "");
  EXPECT_EQ(pointers_of({fluid[0], fluid[1], "material.viscosity_Pa_s=0.001"}), "");
  EXPECT_EQ(pointers_of({fluid[0], fluid[1], "material.cohesion_Pa=500"}), "/material ");
  EXPECT_EQ(pointers_of({fluid[0]}), "/slide/outlines/1/material ") << "a soil over a fluid";
  EXPECT_EQ(pointers_of({"rheology.yield=regularized"}), "");
  EXPECT_FALSE(lacking({"rheology.yield=regularized"}));
}

TEST(Dissipation, AViscosityBelowTheArtificialOneIsWarnedOf) {
  // rho alpha c_s h/8 = 2000 x 0.1 x 100 x 0.75/8 = 1875 Pa s.
  FlowConstants k;
  k.h = 0.75;
  k.c_s = 100.0;
  k.numerics.alpha = 0.1;
  EXPECT_DOUBLE_EQ(artificial_shear_viscosity(k, 2000.0), 1875.0);
  const std::string whole = "numerics.artificial_viscosity_jump=whole",
                    alpha = "numerics.artificial_viscosity_alpha=0.1";
  EXPECT_EQ(pointers_of({"material.viscosity_Pa_s=1876", whole, alpha}), "");
  const std::vector<Fault> warnings = warnings_of({"material.viscosity_Pa_s=1000", whole, alpha});
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].pointer, "/material/viscosity_Pa_s");
  EXPECT_NE(warnings[0].message.find("is 1000 Pa s, less than the artificial viscosity, which acts as about 1880 Pa s"),
            std::string::npos)
      << warnings[0].message;
  EXPECT_EQ(pointers_of({"material.viscosity_Pa_s=1000", alpha, "numerics.artificial_viscosity_jump=reconstructed"}),
            "");
  EXPECT_EQ(pointers_of({"material.viscosity_Pa_s=1000", whole, "numerics.artificial_viscosity_alpha=0.05"}), "");
  EXPECT_EQ(pointers_of({"material.viscosity_Pa_s=188", alpha}), "") << "a tenth is left by reconstruction";
  const std::vector<Fault> tiny = warnings_of({"material.viscosity_Pa_s=1.5", alpha});
  ASSERT_EQ(tiny.size(), 1u);
  EXPECT_EQ(
      tiny[0].message,
      "is 1.5 Pa s, less than the artificial viscosity, which acts as about 188 Pa s at this particle spacing and "
      "decides the run-out; it falls with the spacing; talus validate lists values by soil type");
}

TEST(Dissipation, MuOfIIsJudgedByItsLargestViscosityAndItsGrains) {
  const std::string angle = "material.mu_i.high_rate_friction_angle_deg=36",
                    whole = "numerics.artificial_viscosity_jump=whole";
  // (mu_2 - mu_s)/I_0 d sqrt(rho g H rho_s), H = 7 m: 17.7 kPa s/m d; 1875 Pa s are reached at 0.1 m.
  const auto grains = [&](const std::string& d) { return "material.mu_i.grain_diameter_m=" + d; };
  EXPECT_EQ(pointers_of({angle, whole, grains("0.005")}), "/material/mu_i ");
  EXPECT_EQ(pointers_of({angle, whole, grains("0.12")}), "");
  const std::string smooth = "numerics.artificial_viscosity_jump=reconstructed";
  EXPECT_EQ(pointers_of({angle, smooth, grains("0.005")}), "");
  EXPECT_EQ(pointers_of({angle, smooth, grains("0.5")}), "");
  EXPECT_EQ(pointers_of({angle, smooth, grains("0.51")}), "/material/mu_i/grain_diameter_m ");
}

TEST(Dissipation, SoilTypesAreWhole) {
  for (const SoilType& type : soil_types) {
    EXPECT_FALSE(std::string_view(type.name).empty());
    EXPECT_NE(std::string_view(type.source).find_first_of("0123456789"), std::string_view::npos) << type.name;
    EXPECT_NE(type.eta > 0.0, type.delta_mu > 0.0 && type.I_0 > 0.0) << type.name << ": one law";
    EXPECT_LE(type.eta_low, type.eta) << type.name;
    EXPECT_LE(type.eta, type.eta_high) << type.name;
  }
}

}  // namespace
}  // namespace talus
