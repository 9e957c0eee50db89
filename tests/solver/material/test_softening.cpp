#include <gtest/gtest.h>

#include "material/softening.hpp"

namespace talus {
namespace {

TEST(SofteningLaw, FallsLinearlyFromPeakToResidual) {
  EXPECT_EQ(softened(20e3, 4e3, softened_share(0.0, 0.5)), 20e3);
  EXPECT_DOUBLE_EQ(softened(20e3, 4e3, softened_share(0.125, 0.5)), 20e3 - 0.25 * 16e3);
  EXPECT_DOUBLE_EQ(softened(20e3, 4e3, softened_share(0.5, 0.5)), 4e3);
  EXPECT_DOUBLE_EQ(softened(20e3, 4e3, softened_share(7.0, 0.5)), 4e3);
}

TEST(SofteningLaw, NothingHardens) {
  // A realization may draw a peak below the residual value of its material.
  EXPECT_EQ(softened(3e3, 4e3, 0.7), 3e3);
}

TEST(SofteningLaw, WorkOfABandIsThatOfTheDisplacementWhateverItsWidth) {
  // integral of tau ddelta from 0 to 2 D: (peak + residual)/2 D + residual D, by the strain of a band of width w.
  const double peak = 9e3, residual = 3e3, D = 0.4;
  for (const double width : {0.2, 0.8}) {
    const double strain = residual_strain(D, width);
    const int n = 20000;
    double work = 0.0;
    for (int k = 0; k < n; ++k) {
      const double displacement = 2 * D * (k + 0.5) / n;
      work += softened(peak, residual, softened_share(displacement / width, strain)) * 2 * D / n;
    }
    EXPECT_NEAR(work, 0.5 * (peak + residual) * D + residual * D, 1e-6 * work);
  }
}

TEST(SofteningLaw, PlasticStrainIsTheExcessOverTheYieldStressByTheShearModulus) {
  EXPECT_DOUBLE_EQ(plastic_increment(1300, 1000, 6e6), 300 / 6e6);
  EXPECT_EQ(plastic_increment(900, 1000, 6e6), 0.0);
}

}  // namespace
}  // namespace talus
