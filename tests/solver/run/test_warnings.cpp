#include <gtest/gtest.h>

#include "run/warnings.hpp"

namespace talus {
namespace {

/// A slope of soil on which every warning can be provoked; `changes` are overrides.
Case slope(std::vector<std::string> changes) {
  const Json document = {{"title", "slope"},
                         {"particle_spacing_m", 0.5},
                         {"terrain", {{"bed_m", {{0, 4}, {8, 0}, {60, 0}}}}},
                         {"slide", {{"outlines", {{{"outline_m", {{0, 4}, {8, 0}, {10, 0}, {4, 7}, {0, 7}}}}}}}},
                         {"material", {{"density_kg_m3", 2000}, {"friction_angle_deg", 25}, {"viscosity_Pa_s", 1000}}},
                         {"numerics", {{"artificial_viscosity_jump", "reconstructed"}}},
                         {"time", {{"end_s", 3}}},
                         {"random_field", {{"correlation_length_m", 2}, {"cov_tan_phi", 0.3}, {"terms", 50}}}};
  return load_case(document, "", changes).value;
}

std::string pointers(const std::vector<std::string>& changes) {
  std::string all;
  for (const Fault& warning : warnings_before_run(slope(changes))) all += warning.pointer + " ";
  return all;
}

TEST(WarningsBeforeRun, NoneForAGoodCase) { EXPECT_EQ(pointers({}), ""); }

TEST(WarningsBeforeRun, ASpacingThatLeavesFewRows) {
  EXPECT_EQ(pointers({"particle_spacing_m=0.7"}), "");
  EXPECT_EQ(pointers({"particle_spacing_m=1.2"}), "/particle_spacing_m ");
}

TEST(WarningsBeforeRun, AMassThatIsNotThatOfTheOutlines) {
  EXPECT_EQ(pointers({"particle_placement=nodes", "particle_spacing_m=0.1"}), "");
  EXPECT_EQ(pointers({"particle_placement=nodes"}), "/particle_placement ");
}

TEST(WarningsBeforeRun, ACorrelationLengthBelowTheSpacing) {
  const std::vector<std::string> shorter{"random_field.correlation_length_m=0.49", "random_field.terms=5000",
                                         "random_field.cell_average=false"};
  EXPECT_EQ(pointers(shorter), "/random_field ");
  EXPECT_EQ(pointers({"random_field.correlation_length_m=0.51", "random_field.terms=5000"}), "");
  EXPECT_EQ(pointers({shorter[0], shorter[1], "random_field.cell_average=true"}), "");
  EXPECT_EQ(pointers({"random_field.correlation_length_m=null", "random_field.correlation_length_x_m=2",
                      "random_field.correlation_length_y_m=0.4", "random_field.terms=5000",
                      "random_field.cell_average=false"}),
            "/random_field ");
  EXPECT_EQ(pointers({"random_field.correlation_length_m=null", "random_field.correlation_length_x_m=2",
                      "random_field.correlation_length_y_m=0.4", "random_field.direction=x"}),
            "")
      << "the field does not vary along y";
}

TEST(WarningsBeforeRun, ATruncationThatLosesMostOfTheVariance) {
  EXPECT_EQ(pointers({"random_field.terms=2"}), "/random_field ");
  const std::vector<Fault> warnings = warnings_before_run(slope({"random_field.terms=2"}));
  EXPECT_NE(warnings.at(0).message.find("% of the variance with 2 terms"), std::string::npos);
}

TEST(WarningsBeforeRun, AFixedStepBeyondStability) {
  // h = 0.75 m, c_s = 100 m/s, elastic wave sqrt(1 + 4/3 0.3) c_s: 0.8 h/c = 5.07 ms.
  EXPECT_EQ(pointers({"numerics.sound_speed_m_s=100", "time.fixed_step_s=0.0050"}), "");
  EXPECT_EQ(pointers({"numerics.sound_speed_m_s=100", "time.fixed_step_s=0.0051"}), "/time/fixed_step_s ");
  EXPECT_EQ(pointers({"numerics.sound_speed_m_s=100", "time.fixed_step_s=0.0026", "numerics.integrator=leapfrog"}),
            "/time/fixed_step_s ");
  // The diffusion number nu dt/h^2 with nu = 1000/2 m2/s: 0.8 h^2/nu = 0.9 ms, half of it with the leapfrog.
  EXPECT_EQ(pointers({"material.viscosity_Pa_s=1e6", "time.fixed_step_s=0.00089"}), "");
  EXPECT_EQ(pointers({"material.viscosity_Pa_s=1e6", "time.fixed_step_s=0.00091"}), "/time/fixed_step_s ");
  EXPECT_EQ(pointers({"material.viscosity_Pa_s=1e6", "time.fixed_step_s=0.00046", "numerics.integrator=leapfrog"}),
            "/time/fixed_step_s ");
}

}  // namespace
}  // namespace talus
