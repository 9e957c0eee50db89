#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "math/angle.hpp"
#include "particles/fill.hpp"
#include "particles/geometry.hpp"
#include "particles/ground.hpp"

namespace talus {
namespace {

/// Ground far below everything.
const std::vector<Polyline> deep{{{{-1e3, -1e3}, {1e3, -1e3}}, false}};

std::vector<SoilPoint> cut(const std::vector<SlidePart>& slide, double dx, const std::vector<Polyline>& walls = deep) {
  return fill_slide(slide, walls, dx, Placement::cells);
}

/// Area that the particles of a material stand for [m2].
double filled(const std::vector<SoilPoint>& points, double dx, int material = 0) {
  double sum = 0.0;
  for (const SoilPoint& p : points)
    if (p.material == material) sum += p.cells * dx * dx;
  return sum;
}

/// A slab on a plane that falls to the right by `angle`.
std::vector<Vec2> slab(double length, double thickness, double angle, Vec2 origin = {0, 0}) {
  const Vec2 along{std::cos(angle), -std::sin(angle)}, up{std::sin(angle), std::cos(angle)};
  return {origin, origin + length * along, origin + length * along + thickness * up, origin + thickness * up};
}

TEST(Fill, TilesARectangleWithCellCentres) {
  const std::vector<Polyline> ground{{{{-1, 0}, {5, 0}}, false}};
  const auto points =
      fill_slide(std::vector<SlidePart>{{{{0, 0}, {2, 0}, {2, 1}, {0, 1}}, 0}}, ground, 0.1, Placement::cells);
  ASSERT_EQ(points.size(), 20u * 10u);
  EXPECT_NEAR(points.front().x.x, 0.05, 1e-12);
  EXPECT_NEAR(points.front().x.y, 0.05, 1e-12);
  for (const SoilPoint& p : points) EXPECT_EQ(p.cells, 1.0);
  const auto whole =
      fill_slide(std::vector<SlidePart>{{{{0, 0}, {2, 0}, {2, 1}, {0, 1}}, 0}}, ground, 0.1, Placement::whole_cells);
  ASSERT_EQ(whole.size(), points.size());
  for (std::size_t k = 0; k < whole.size(); ++k) {
    EXPECT_EQ(whole[k].x.x, points[k].x.x);
    EXPECT_EQ(whole[k].x.y, points[k].x.y);
  }
}

TEST(Fill, OnNodesIncludesTheEdges) {
  const std::vector<Boundary> bed{{.line = {{{-1, 0}, {12, 0}}, false}}};
  const auto ground = wall_lines(bed, 0.1, Placement::nodes);
  const auto points =
      fill_slide(std::vector<SlidePart>{{{{0, 0}, {10, 0}, {10, 4}, {0, 4}}, 0}}, ground, 0.1, Placement::nodes);
  EXPECT_EQ(points.size(), 101u * 41u);  // [Z20] 3.1
}

TEST(Fill, KeepsHalfASpacingFromASlopingBed) {
  const Terrain slope{{{0, 5}, {10, 0}, {20, 0}}, false, true, false, 9, 0};
  const std::vector<Polyline> walls{ground_line(slope)};
  const auto points =
      fill_slide(std::vector<SlidePart>{{{{0, 5}, {10, 0}, {10, 6}, {0, 6}}, 0}}, walls, 0.2, Placement::whole_cells);
  ASSERT_FALSE(points.empty());
  const Ground ground(walls);
  for (const SoilPoint& p : points) EXPECT_GE(ground.nearest(p.x).distance, 0.1 - 1e-6);
}

TEST(Fill, GivesEachLayerItsMaterial) {
  const std::vector<Polyline> ground{{{{-1, 0}, {5, 0}}, false}};
  const std::vector<SlidePart> layers{{{{0, 0}, {2, 0}, {2, 1}, {0, 1}}, 0}, {{{0, 1}, {2, 1}, {2, 2}, {0, 2}}, 1}};
  for (const SoilPoint& p : fill_slide(layers, ground, 0.25, Placement::cells))
    EXPECT_EQ(p.material, p.x.y > 1 ? 1 : 0);
}

TEST(Fill, TheAreaIsThatOfTheOutlineAtAnyAngleThicknessAndSpacing) {
  for (double angle : {0.0, 10.0, 30.0, 45.0, 63.4, 90.0})
    for (double thickness : {0.1, 0.3, 2.0, 4.25})
      for (double dx : {0.5, 0.37, 0.1}) {
        const std::vector<SoilPoint> points = cut({{slab(4.0, thickness, radians(angle), {3.3, 20.7}), 0}}, dx);
        EXPECT_NEAR(filled(points, dx), 4.0 * thickness, 1e-5 * 4.0 * thickness)
            << angle << " deg, " << thickness << " m, spacing " << dx;
      }
}

TEST(Fill, TheCentreOfMassIsThatOfTheOutline) {
  const std::vector<Vec2> triangle{{0.13, 0.2}, {4.1, 1.3}, {1.7, 3.9}};
  Vec2 first;
  for (const SoilPoint& p : cut({{triangle, 0}}, 0.3)) first += p.cells * 0.3 * 0.3 * p.x;
  const Vec2 centre = (1.0 / 3.0) * (triangle[0] + triangle[1] + triangle[2]);
  EXPECT_NEAR(first.x / area(triangle), centre.x, 1e-6);
  EXPECT_NEAR(first.y / area(triangle), centre.y, 1e-6);
}

TEST(Fill, AnOutlineThatIsNotConvexKeepsItsAreaAndItsHoleStaysEmpty) {
  const std::vector<Vec2> fork{{0, 0}, {3, 0}, {3, 5}, {0, 5}, {0, 4}, {2, 4}, {2, 1}, {0, 1}};
  const std::vector<SoilPoint> points = cut({{fork, 0}}, 0.35);
  EXPECT_NEAR(filled(points, 0.35), 3 * 5 - 2 * 3.0, 1e-5);
  for (const SoilPoint& p : points) EXPECT_FALSE(p.x.x < 1.9 && p.x.y > 1.1 && p.x.y < 3.9) << p.x.x << " " << p.x.y;
}

TEST(Fill, ALayerThinnerThanAParticleHasItsMass) {
  const std::vector<SoilPoint> points = cut({{slab(10.0, 0.05, radians(20)), 0}}, 0.5);
  EXPECT_NEAR(filled(points, 0.5), 10.0 * 0.05, 1e-5);
  EXPECT_GE(points.size(), 2u);
  const std::vector<SoilPoint> speck = cut({{slab(0.1, 0.05, radians(20)), 0}}, 0.5);
  ASSERT_EQ(speck.size(), 1u);
  EXPECT_NEAR(speck[0].cells, 0.1 * 0.05 / (0.5 * 0.5), 1e-5);
}

TEST(Fill, WhereTwoMaterialsMeetEachHasItsArea) {
  const std::vector<Vec2> lower{{0, 0}, {9, 0}, {9, 0.7}, {0, 2.3}}, upper{{0, 2.3}, {9, 0.7}, {8, 3}, {1, 4}};
  const std::vector<SoilPoint> points = cut({{lower, 0}, {upper, 1}}, 0.4);
  EXPECT_NEAR(filled(points, 0.4, 0), area(lower), 1e-5 * area(lower));
  EXPECT_NEAR(filled(points, 0.4, 1), area(upper), 1e-5 * area(upper));
}

TEST(Fill, NoParticleIsSmallerThanHalfACell) {
  for (double angle : {5.0, 30.0, 45.0, 80.0})
    for (const SoilPoint& p : cut({{slab(4.0, 2.0, radians(angle)), 0}}, 0.25)) {
      EXPECT_GE(p.cells, least_cells - 1e-5);
      EXPECT_LE(p.cells, 2.5) << "joined more than it had to";
    }
}

TEST(Fill, RandomOutlinesKeepTheirArea) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> radius(0.3, 3.0), spacing(0.1, 0.9);
  for (int k = 0; k < 300; ++k) {
    std::vector<Vec2> star;
    for (int v = 0; v < 12; ++v) {
      const double turn = radians(30.0 * v), r = radius(random);
      star.push_back({r * std::cos(turn), r * std::sin(turn)});
    }
    const double dx = spacing(random);
    EXPECT_NEAR(filled(cut({{star, 0}}, dx), dx), area(star), 1e-5 * area(star)) << "outline " << k;
  }
}

TEST(Fill, TheLatticeHangsOnTheSlide) {
  const std::vector<Vec2> outline{{0, 8.2}, {14.202, 0}, {21.325, 0}, {9.125, 12.2}, {0, 12.2}};
  const std::vector<SoilPoint> here = cut({{outline, 0}}, 0.4);
  for (const Vec2 shift : {Vec2{0, 1234.5}, Vec2{-77.7, 0.1}, Vec2{2'683'000, 1'247'000}}) {
    std::vector<Vec2> moved;
    for (const Vec2& v : outline) moved.push_back(v + shift);
    const std::vector<Polyline> ground{{{{shift.x - 1e3, shift.y - 1e3}, {shift.x + 1e3, shift.y - 1e3}}, false}};
    const std::vector<SoilPoint> there = cut({{moved, 0}}, 0.4, ground);
    ASSERT_EQ(there.size(), here.size()) << shift.x << " " << shift.y;
    for (std::size_t k = 0; k < here.size(); ++k) {
      EXPECT_NEAR(norm(there[k].x - (here[k].x + shift)), 0.0, 1e-6);
      EXPECT_NEAR(there[k].cells, here[k].cells, 1e-6);
    }
  }
}

const std::vector<Lattice> lattices{
    {{0.25, 0.5}}, {{0.9, 0.1}}, {{}, radians(15)}, {{}, radians(45)}, {{0.3, 0.7}, radians(-70)}};

TEST(Lattice, AnyLatticeKeepsMassAndCentreOfMass) {
  const std::vector<Vec2> slope{{0, 8.2}, {14.202, 0}, {21.325, 0}, {9.125, 12.2}, {0, 12.2}};
  const std::vector<Vec2> triangle{{0.13, 0.2}, {4.1, 1.3}, {1.7, 3.9}};
  const Vec2 centre = (1.0 / 3.0) * (triangle[0] + triangle[1] + triangle[2]);
  for (const Lattice& lattice : lattices) {
    const auto fill = [&](const std::vector<Vec2>& outline, double dx) {
      return fill_slide(std::vector<SlidePart>{{outline, 0}}, deep, dx, Placement::cells, SlidesTo::right, lattice);
    };
    EXPECT_NEAR(filled(fill(slope, 0.4), 0.4), area(slope), 1e-5 * area(slope));
    EXPECT_NEAR(filled(fill(slab(4.0, 0.3, radians(30)), 0.5), 0.5), 4.0 * 0.3, 1e-5);
    Vec2 first;
    for (const SoilPoint& p : fill(triangle, 0.3)) first += p.cells * 0.3 * 0.3 * p.x;
    EXPECT_NEAR(first.x / area(triangle), centre.x, 1e-6);
    EXPECT_NEAR(first.y / area(triangle), centre.y, 1e-6);
  }
}

TEST(Lattice, WholeCellsStandOnTheLattice) {
  const double dx = 0.25, width = 20.0, height = 10.0;
  const Vec2 corner{3.0, 7.0};
  const std::vector<Vec2> outline{corner, corner + Vec2{width, 0}, corner + Vec2{width, height},
                                  corner + Vec2{0, height}};
  const auto from_half = [](double u) { return u - 0.5 - std::round(u - 0.5); };
  for (const Lattice& lattice : lattices) {
    int whole = 0;
    const double c = std::cos(lattice.angle), s = std::sin(lattice.angle);
    const auto points =
        fill_slide(std::vector<SlidePart>{{outline, 0}}, deep, dx, Placement::cells, SlidesTo::right, lattice);
    for (const SoilPoint& p : points) {
      if (p.cells != 1.0) continue;
      ++whole;
      const Vec2 d = (1.0 / dx) * (p.x - corner);
      EXPECT_NEAR(from_half(c * d.x + s * d.y - lattice.shift.x), 0.0, 1e-9);
      EXPECT_NEAR(from_half(c * d.y - s * d.x - lattice.shift.y), 0.0, 1e-9);
    }
    // Cells that the edges cut lie within a diagonal of them; a particle stands for at least half a cell.
    const double cells = width * height / (dx * dx), rim = std::sqrt(2.0) * 2.0 * (width + height) / dx;
    EXPECT_GE(whole, cells - 2.0 * rim);
    EXPECT_LE(std::abs(static_cast<double>(points.size()) - cells), rim);
  }
}

TEST(Lattice, AQuarterTurnIsTheSameLattice) {
  // Pieces of 0.8, 0.7 and 0.56 cells: none is joined to another.
  const std::vector<SlidePart> slide{{{{1, 2}, {1 + 4.32, 2}, {1 + 4.32, 2 + 2.28}, {1, 2 + 2.28}}, 0}};
  const auto here = fill_slide(slide, deep, 0.4, Placement::cells);
  EXPECT_EQ(here.size(), 11u * 6u);
  for (double turn : {90.0, -90.0}) {
    const auto turned = fill_slide(slide, deep, 0.4, Placement::cells, SlidesTo::right, {{}, radians(turn)});
    ASSERT_EQ(turned.size(), here.size());
    for (const SoilPoint& p : turned)
      EXPECT_TRUE(std::ranges::any_of(
          here, [&](const SoilPoint& q) { return norm(p.x - q.x) < 1e-9 && std::abs(p.cells - q.cells) < 1e-9; }))
          << p.x.x << " " << p.x.y;
  }
}

TEST(Lattice, IsMirroredWithTheSlide) {
  const std::vector<SlidePart> right{{{{0, 5}, {10, 0}, {12, 0}, {5, 8}, {0, 8}}, 0}};
  const std::vector<SlidePart> left{{{{0, 5}, {-10, 0}, {-12, 0}, {-5, 8}, {0, 8}}, 0}};
  const Lattice lattice{{0.25, 0.5}, radians(15)};
  const auto there = fill_slide(right, deep, 0.5, Placement::cells, SlidesTo::right, lattice);
  const auto back = fill_slide(left, deep, 0.5, Placement::cells, SlidesTo::left, lattice);
  ASSERT_EQ(there.size(), back.size());
  for (std::size_t k = 0; k < there.size(); ++k) EXPECT_EQ(back[k].x, (Vec2{-there[k].x.x, there[k].x.y}));
}

TEST(Fill, NoParticleStartsWithinReachOfTheGround) {
  // The ground lies up to 0.4 m above the outline's lower edge.
  const std::vector<Polyline> ground{{{{-1, 0.3}, {2, 0.4}, {5, -0.2}}, false}};
  const std::vector<SoilPoint> points = cut({{{{0, 0}, {4, 0}, {4, 2}, {0, 2}}, 0}}, 0.25, ground);
  EXPECT_NEAR(filled(points, 0.25), 8.0, 1e-5);
  const Ground nearest(ground);
  for (const SoilPoint& p : points) EXPECT_GE(nearest.nearest(p.x).distance, least_distance * 0.25 - 1e-9);
}

TEST(Fill, WholeCellsAndNodesStandForOneCellEach) {
  for (Placement placement : {Placement::whole_cells, Placement::nodes})
    for (const SoilPoint& p : fill_slide(std::vector<SlidePart>{{slab(4, 2, radians(30)), 0}}, deep, 0.25, placement))
      EXPECT_EQ(p.cells, 1.0);
}

}  // namespace
}  // namespace talus
