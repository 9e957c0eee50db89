#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "case/outline.hpp"
#include "case/overlay.hpp"
#include "particles/geometry.hpp"

namespace talus {
namespace {

using Points = std::vector<Vec2>;

TEST(SelfIntersection, FindsCrossingTouchingAndFolding) {
  EXPECT_FALSE(self_intersection(Points{{0, 0}, {2, 0}, {2, 1}, {0, 1}}, true));
  EXPECT_FALSE(self_intersection(Points{{0, 0}, {1, 0}, {2, 0}, {2, 1}}, true)) << "a straight corner is no fold";
  const auto bow_tie = self_intersection(Points{{0, 0}, {2, 2}, {2, 0}, {0, 2}}, true);
  ASSERT_TRUE(bow_tie);
  EXPECT_EQ(bow_tie->first, 0u);
  EXPECT_EQ(bow_tie->second, 2u);
  EXPECT_TRUE(self_intersection(Points{{0, 0}, {4, 0}, {4, 4}, {2, 0}, {0, 4}}, true)) << "a vertex on another edge";
  EXPECT_TRUE(self_intersection(Points{{0, 0}, {2, 0}, {1, 0}, {1, 3}}, true)) << "an edge folded back";
  EXPECT_TRUE(self_intersection(Points{{0, 0}, {2, 0}, {2, 0}, {1, 3}}, true)) << "a vertex repeated";
  EXPECT_TRUE(self_intersection(Points{{0, 0}, {2, 0}, {1, 0}}, true)) << "a triangle without area";
  EXPECT_TRUE(self_intersection(Points{{0, 0}, {4, 0}, {4, 4}, {2, 2}, {4, 4}, {0, 4}}, true)) << "a spike to a vertex";
}

TEST(SelfIntersection, AnOpenLineMayEndWhereARingMayNot) {
  const Points u = {{0, 0}, {0, 2}, {2, 2}, {2, 0}};
  EXPECT_FALSE(self_intersection(u, false));
  const Points hook = {{0, 0}, {2, 0}, {2, 2}, {1, -1}};
  EXPECT_TRUE(self_intersection(hook, false));
}

TEST(SelfIntersection, StarOfManyVerticesIsSimpleUntilTwoAreSwapped) {
  Points star;
  for (int k = 0; k < 500; ++k) {
    const double angle = 2 * M_PI * k / 500, r = k % 2 == 0 ? 1.0 : 0.8;
    star.push_back({r * std::cos(angle), r * std::sin(angle)});
  }
  EXPECT_FALSE(self_intersection(star, true));
  std::swap(star[100], star[103]);
  EXPECT_TRUE(self_intersection(star, true));
}

TEST(SharedArea, IsThatOfTheOverlap) {
  const Points square = {{0, 0}, {2, 0}, {2, 2}, {0, 2}}, clockwise(square.rbegin(), square.rend());
  const Points moved = {{1.5, 0.5}, {3, 0.5}, {3, 1.5}, {1.5, 1.5}};
  EXPECT_NEAR(shared_area(square, moved), 0.5 * 1.0, 1e-6);
  EXPECT_NEAR(shared_area(clockwise, moved), 0.5 * 1.0, 1e-6);
  const Points beside = {{2, 0}, {3, 0}, {3, 2}, {2, 2}};
  EXPECT_NEAR(shared_area(square, beside), 0.0, 1e-6) << "layers share an edge";
}

TEST(BetweenSurfaces, GivesThePieceBetween) {
  // A parabola-like ground of 3 points over a flat slip surface: triangle of base 4 and height 2.
  const auto pieces = between_surfaces(Points{{0, 0}, {2, 2}, {4, 0}}, Points{{-1, 0}, {5, 0}});
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_NEAR(signed_area(pieces[0]), 0.5 * 4 * 2, 1e-9);
  EXPECT_NEAR(pieces[0][0].x, 0.0, 1e-9) << "starts at the left";
}

TEST(BetweenSurfaces, GivesSeveralPiecesFromLeftToRight) {
  // sin-like zigzag about the slip surface y = 0: above it on (0,2) and (4,6), below it on (2,4).
  const auto pieces = between_surfaces(Points{{0, 0}, {1, 1}, {3, -1}, {5, 1}, {6, 0}}, Points{{0, 0}, {6, 0}});
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_NEAR(signed_area(pieces[0]), 0.5 * 2 * 1, 1e-9);
  EXPECT_NEAR(signed_area(pieces[1]), 0.5 * 2 * 1, 1e-9);
  EXPECT_LT(pieces[0][0].x, pieces[1][0].x);
}

TEST(BetweenSurfaces, TakesCliffsAndShortSurfaces) {
  // A vertical step from 0 to 3 at x = 2; the slip surface spans 1..4 only.
  const auto pieces = between_surfaces(Points{{0, 0}, {2, 0}, {2, 3}, {6, 3}}, Points{{1, 1}, {4, 1}});
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_NEAR(signed_area(pieces[0]), 2.0 * 2.0, 1e-9);
  EXPECT_TRUE(between_surfaces(Points{{0, 0}, {1, 0}}, Points{{0, 1}, {1, 1}}).empty());
  EXPECT_TRUE(between_surfaces(Points{{0, 0}, {1, 0}}, Points{{2, -1}, {3, -1}}).empty()) << "no common extent";
}

TEST(HeightBeneath, IsThatOfTheHighestCrossingBelowThePoint) {
  const Points overhang = {{0, 10}, {10, 10}, {8, 6}, {8, 0}, {40, 0}};
  EXPECT_DOUBLE_EQ(height_beneath(overhang, {5, 12}), 10);
  EXPECT_DOUBLE_EQ(height_beneath(overhang, {9, 12}), 10);
  EXPECT_DOUBLE_EQ(height_beneath(overhang, {9, 4}), 0) << "beneath the overhang";
  EXPECT_DOUBLE_EQ(height_beneath(overhang, {30, 1}), 0);
  EXPECT_DOUBLE_EQ(height_beneath(overhang, {50, 3}), 3) << "no bed there";
}

/// Random outlines that hang over or dip into a random bed, star-shaped about their middle.
TEST(ReachOutsideRing, FindsWhatDenseSamplingFinds) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(0.0, 10.0);
  int deep = 0;
  for (int trial = 0; trial < 50; ++trial) {
    Points bed, outline;
    for (int k = 0; k <= 10; ++k) bed.push_back({static_cast<double>(k), 0.3 * u(random)});
    for (int k = 0; k < 5; ++k) {
      const double angle = 2 * M_PI * k / 5, r = 1 + 0.2 * u(random);
      outline.push_back({5 + r * std::cos(angle), 3.5 + r * std::sin(angle)});
    }
    // The deepest sample of the outline's edge in the rock, by its distance to the bed.
    double sampled = 0.0;
    for (std::size_t k = 0; k < outline.size(); ++k)
      for (int i = 0; i <= 200; ++i) {
        const Vec2 p = outline[k] + (i / 200.0) * (outline[(k + 1) % outline.size()] - outline[k]);
        double distance = 1e300, height = 0.0;
        for (std::size_t s = 0; s + 1 < bed.size(); ++s) {
          const Vec2 a = bed[s], ab = bed[s + 1] - a;
          distance = std::min(distance, norm(p - a - std::clamp(dot(p - a, ab) / norm2(ab), 0.0, 1.0) * ab));
          if (a.x <= p.x && p.x <= bed[s + 1].x) height = a.y + ab.y * (p.x - a.x) / ab.x;
        }
        if (p.y < height) sampled = std::max(sampled, distance);
      }
    const double depth = reach_outside_ring(outline, room_above(bed, 10)).depth;
    EXPECT_GE(depth, 0.5 * sampled - 1e-9) << trial;
    EXPECT_EQ(depth > 1e-9, sampled > 0.0) << trial;
    deep += sampled > 0.3 ? 1 : 0;
  }
  EXPECT_GT(deep, 10);
}

TEST(ReachOutsideRing, SeesAHumpUnderAnEdgeAndAWallAcross) {
  const Points hump = room_above(Points{{0, 0}, {5, 1}, {10, 0}}, 5), outline = {{1, 0.2}, {9, 0.2}, {9, 3}, {1, 3}};
  EXPECT_NEAR(reach_outside_ring(outline, hump).depth, 0.8, 1e-12);
  EXPECT_EQ(reach_outside_ring(Points{{1, 1}, {9, 1}, {5, 3}}, hump).depth, 0.0);
  const Points wall = room_above(Points{{0, 0}, {5, 0}, {5, 4}, {5.5, 4}, {5.5, 0}, {10, 0}}, 5);
  EXPECT_NEAR(reach_outside_ring(Points{{1, 0}, {9, 0}, {9, 2}, {1, 2}}, wall).depth, 2 * (0.5 * 2) / (2 * 2.5), 1e-9);
  const Points cliff = room_above(Points{{0, 10}, {10, 10}, {10, 0}, {40, 0}}, 20);
  EXPECT_NEAR(reach_outside_ring(Points{{9.9, 0}, {15, 0}, {15, 8}, {9.9, 8}}, cliff).depth, 0.1, 0.02)
      << "into the face, not below the crest";
}

TEST(ReachOutsideRing, MeasuresOverhangAndCoveredRock) {
  const Points ring = {{0, 0}, {10, 0}, {10, 6}, {0, 6}};
  EXPECT_EQ(reach_outside_ring(Points{{0, 0}, {10, 0}, {10, 4}, {0, 4}}, ring).depth, 0.0);
  EXPECT_NEAR(reach_outside_ring(Points{{0, 0}, {10, 0}, {10, 7}, {0, 7}}, ring).depth, 1.0, 1e-9);
  const Points notched = {{0, 0}, {4, 0}, {4, 3}, {6, 3}, {6, 0}, {10, 0}, {10, 6}, {0, 6}};
  EXPECT_NEAR(reach_outside_ring(Points{{0, 0}, {10, 0}, {10, 4}, {0, 4}}, notched).depth, 2.0 * 6.0 / 10.0, 1e-9);
}

}  // namespace
}  // namespace talus
