#include <gtest/gtest.h>

#include <cmath>

#include "particles/geometry.hpp"

namespace talus {
namespace {

TEST(Walls, FrameOfTheFieldCheckHas1008Particles) {  // [Z20] 3.1: closed frame, 3 layers, interior 10 x 6 m
  const Terrain box{{{0, 0}, {10, 0}, {10, 6}, {0, 6}}, true, false, false, 0, 0};
  const auto points =
      fill_walls(wall_lines(std::vector{Boundary{.line = ground_line(box)}}, 0.1, Placement::nodes).front(), 0.1, 3);
  EXPECT_EQ(points.size(), 1008u);
  for (const WallPoint& w : points) {  // on the lattice, outside the box
    EXPECT_NEAR(w.x.x * 10, std::round(w.x.x * 10), 1e-9);
    EXPECT_NEAR(w.x.y * 10, std::round(w.x.y * 10), 1e-9);
    EXPECT_TRUE(w.x.x < -0.05 || w.x.x > 10.05 || w.x.y < -0.05 || w.x.y > 6.05);
  }
}

TEST(Walls, LayersOfAFlatBed) {
  const auto points = fill_walls({{{0, 0}, {4, 0}}, false}, 0.1, 3);
  ASSERT_EQ(points.size(), 3u * 40u);
  for (const WallPoint& w : points) {
    EXPECT_NEAR(w.depth, -w.x.y, 1e-12);
    EXPECT_NEAR(w.n.x, 0, 1e-12);
    EXPECT_NEAR(w.n.y, 1, 1e-12);
  }
}

TEST(Walls, NormalsPointFromEveryParticleToItsFoot) {
  const Polyline line{{{0, 8}, {0, 5}, {8, 0}, {11, 2}, {20, 2}}, false};  // wall, slope, valley, ridge
  for (const WallPoint& w : fill_walls(line, 0.2, 4)) {
    EXPECT_NEAR(norm(w.n), 1.0, 1e-12);
    EXPECT_GT(w.depth, 0.0);
    EXPECT_NEAR(norm(w.x + w.depth * w.n - project(w.x, line).point), 0.0, 1e-9);
    EXPECT_LT(project(w.x, line).distance, 0.0);
  }
}

TEST(Walls, NoGapsAlongASlopingBed) {
  const Polyline line{{{0, 5}, {8, 0}, {20, 0}}, false};
  const auto points = fill_walls(line, 0.2, 3);
  for (double s = 0.2; s < line.length() - 0.2; s += 0.05) {
    double gap = 1e9;
    for (const WallPoint& w : points) gap = std::min(gap, norm(w.x - line.at(s)));
    EXPECT_LT(gap, 0.2) << "at arc length " << s;
  }
}

}  // namespace
}  // namespace talus
