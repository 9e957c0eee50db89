#include <gtest/gtest.h>

#include <cmath>

#include "material/equation_of_state-inl.hpp"

namespace talus {
namespace {

using namespace HWY_NAMESPACE;

double pressure_of(const EquationOfState& eos, double rho) { return pressure(eos.B, rho / eos.rho0 - 1.0); }

TEST(EquationOfState, SlopeAtTheReferenceDensityIsTheSpeedOfSoundSquared) {
  const auto eos = EquationOfState::weakly_compressible(2200, 150);
  const double d = 1e-3;
  EXPECT_NEAR((pressure_of(eos, 2200 + d) - pressure_of(eos, 2200 - d)) / (2 * d), 150.0 * 150.0, 1e-3);
  EXPECT_EQ(pressure_of(eos, 2200), 0.0);
}

TEST(EquationOfState, IsTheSeventhPower) {
  const EquationOfState eos{1000, 3e6};
  EXPECT_NEAR(pressure_of(eos, 1100), 3e6 * (std::pow(1.1, 7) - 1), 1e-6);
}

TEST(EquationOfState, DensityInvertsPressure) {
  const auto eos = EquationOfState::weakly_compressible(1850, 90);
  for (const double p : {-1e5, 0.0, 3e4, 2e6}) EXPECT_NEAR(pressure_of(eos, eos.density(p)), p, 1e-12 * eos.B);
}

TEST(EquationOfState, LooseSoilCarriesNoTension) {
  EXPECT_EQ(apply_tension_cutoff(-5.0), 0.0);
  EXPECT_EQ(apply_tension_cutoff(5.0), 5.0);
}

}  // namespace
}  // namespace talus
