#include <gtest/gtest.h>

#include <cmath>

#include "material/constitutive_models-inl.hpp"

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

TEST(EquationOfState, EnergyIsTheIntegralOfPressureOverDensitySquared) {
  const auto eos = EquationOfState::weakly_compressible(1850, 90);
  EXPECT_EQ(eos.energy(1850), 0.0);
  for (const double rho : {1700.0, 1849.0, 1900.0, 2100.0}) {
    const auto integrand = [&](double x) { return pressure_of(eos, x) / (x * x); };
    double sum = 0.0;  // Simpson
    constexpr int intervals = 200;
    const double step = (rho - 1850) / intervals;
    for (int i = 0; i < intervals; ++i) {
      const double x = 1850 + i * step;
      sum += step / 6 * (integrand(x) + 4 * integrand(x + 0.5 * step) + integrand(x + step));
    }
    EXPECT_NEAR(eos.energy(rho), sum, 1e-9 * sum);
    EXPECT_GT(sum, 0.0);
  }
}

TEST(EquationOfState, LooseSoilCarriesNoTension) {
  EXPECT_EQ(apply_tension_cutoff(-5.0), 0.0);
  EXPECT_EQ(apply_tension_cutoff(5.0), 5.0);
}

}  // namespace
}  // namespace talus
