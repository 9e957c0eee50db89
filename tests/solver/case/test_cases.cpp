// The cases that Talus ships: sound, and as large as they say.

#include <gtest/gtest.h>

#include <filesystem>

#include "case/load.hpp"
#include "particles/geometry.hpp"
#include "simulation/simulation.hpp"

namespace talus {
namespace {

LoadedCase shipped(const std::string& name) {
  return load_case(std::filesystem::path(TALUS_SOURCE_DIR) / "solver/cases" / (name + ".json"));
}

ParticlePlan plan_of(const std::string& name) { return plan_particles(shipped(name).value.model); }

TEST(Cases, FieldCheckHasTheParticlesOfThePaper) {
  const ParticlePlan plan = plan_of("field-check");  // [Z20] section 3.1
  EXPECT_EQ(plan.soil.size(), 4141u);
  EXPECT_EQ(plan.walls.size(), 1008u);
}

TEST(Cases, IllustrativeHasTheParticlesOfThePaper) {
  EXPECT_NEAR(static_cast<double>(plan_of("illustrative").soil.size()), 12'700.0, 0.01 * 12'700);
  EXPECT_EQ(plan_of("table4-case1").soil.size(), 12'700u);
}

TEST(Cases, YangbaodiLikeHasSectionAndParticlesOfThePaper) {
  EXPECT_NEAR(area(shipped("yangbaodi-like").value.model.slide[0].outline), 479.0, 0.5);
  EXPECT_NEAR(static_cast<double>(plan_of("yangbaodi-like").soil.size()), 11'978.0, 0.01 * 11'978);
}

TEST(Cases, RodsAndWaterFillTheirColumns) {
  EXPECT_EQ(plan_of("aluminium-rods").soil.size(), 100u * 50u);
  EXPECT_EQ(plan_of("dam-break").soil.size(), 40u * 80u);
}

TEST(Cases, Table4VariesSpreadAndCorrelationOnly) {
  const double stdev[] = {0.0763, 0.1526, 0.2289, 0.3052, 0.3814, 0.2289, 0.2289, 0.2289, 0.2289};  // [Z20] Table 4
  const double length[] = {0.5, 0.5, 0.5, 0.5, 0.5, 0.1, 0.2, 0.3, 0.4};
  const Model model = shipped("table4-case1").value.model;
  EXPECT_EQ(model.rheology.yield, Yield::regularized);
  EXPECT_EQ(model.walls.contact, WallContact::approaching);
  EXPECT_EQ(model.time.fixed_step, 3e-4);
  for (int k = 0; k < 9; ++k) {
    const Case c = shipped("table4-case" + std::to_string(k + 1)).value;
    EXPECT_EQ(c.model, model);
    EXPECT_EQ(c.field->sigma, stdev[k]);
    EXPECT_EQ(c.field->ell_x, length[k]);
    EXPECT_EQ(c.field->ell_y, length[k]);
    EXPECT_EQ(c.field->mu, -0.7629);
    EXPECT_EQ(c.field->terms, 5);
    EXPECT_EQ(c.study.realizations, 1000);
  }
  EXPECT_EQ(shipped("illustrative").value.model.slide, model.slide) << "the same profile";
}

}  // namespace
}  // namespace talus
