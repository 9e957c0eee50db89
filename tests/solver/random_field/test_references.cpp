// Correlations and Karhunen-Loeve shares against GSTools and OpenTURNS: data/make_references.py.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "random_field/bedding.hpp"
#include "random_field/grid_expansion.hpp"
#include "reference_table.hpp"

namespace talus {
namespace {

TEST(References, CorrelationsAreThoseOfGsToolsAndOpenTurns) {
  std::size_t rows = 0;
  for (const auto& row : test::reference_table("correlations.csv")) {
    const FieldSpec spec{.ell_x = std::stod(row.at("ell_x")),
                         .ell_y = std::stod(row.at("ell_y")),
                         .covariance = test::family_named(row.at("family"))};
    const Bedding bedding(std::stod(row.at("dip_deg")) * std::numbers::pi / 180);
    const double rho = Correlation(spec)(bedding.turned(Vec2{std::stod(row.at("dx")), std::stod(row.at("dy"))}));
    EXPECT_NEAR(rho, std::stod(row.at("openturns")), 1e-8) << row.at("family");  // it adds 1e-12 at the lag 0
    if (!row.at("gstools").empty()) EXPECT_NEAR(rho, std::stod(row.at("gstools")), 1e-8) << row.at("family");
    ++rows;
  }
  EXPECT_EQ(rows, 72u);
}

// Both discretise. Linear elements of 0.13 m there carry less in the higher modes, which turn within some elements.
TEST(References, SharesAreThoseOfOpenTurns) {
  std::size_t rows = 0;
  std::string last;
  std::vector<double> shares;
  for (const auto& row : test::reference_table("shares.csv")) {
    if (row.at("family") != last) {
      last = row.at("family");
      const FieldSpec spec{.ell_x = 2.0, .ell_y = 0.7, .terms = 12, .covariance = test::family_named(last)};
      shares = GridExpansion(spec, {{0, 0}, {6, 2}}, 0.1).shares();
    }
    const double expected = std::stod(row.at("share"));
    const std::size_t mode = std::stoul(row.at("mode"));
    EXPECT_NEAR(shares.at(mode), expected, (mode < 6 ? 0.03 : 0.06) * expected) << last << ' ' << mode;
    ++rows;
  }
  EXPECT_EQ(rows, 48u);
}

}  // namespace
}  // namespace talus
