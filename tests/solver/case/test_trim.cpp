#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "case/outline.hpp"
#include "case/overlay.hpp"
#include "documents.hpp"
#include "particles/geometry.hpp"
#include "simulation/particle_setup.hpp"

namespace talus {
namespace {

using Points = std::vector<Vec2>;
using test::faults_of;
using test::load;
using test::with;

double total_area(const Pieces& pieces) {
  double sum = 0.0;
  for (const auto& piece : pieces) sum += area(piece);
  return sum;
}

TEST(SplitArea, IsExactForConvexAndNotchedRings) {
  const Points square = {{0, 0}, {2, 0}, {2, 2}, {0, 2}}, clockwise(square.rbegin(), square.rend());
  const Points diamond = {{2, 0}, {3, 1}, {2, 2}, {1, 1}};  // half of it, area 1, in the square
  for (const Points& outline : {square, clockwise}) {
    EXPECT_NEAR(split_area(outline, diamond).inside, 1.0, 1e-14);
    EXPECT_NEAR(split_area(outline, diamond).outside, 3.0, 1e-14);
  }
  EXPECT_NEAR(split_area(diamond, square).inside, 1.0, 1e-14);
  const Points comb = {{0, 0}, {5, 0}, {5, 3}, {4, 3}, {4, 1}, {1, 1}, {1, 3}, {0, 3}};
  EXPECT_NEAR(split_area(Points{{0, 2}, {5, 2}, {5, 3}, {0, 3}}, comb).inside, 2.0, 1e-14) << "two prongs";
  EXPECT_EQ(split_area(square, Points{{2, 0}, {3, 0}, {3, 2}, {2, 2}}).inside, 0.0) << "they share an edge";
  // Far from zero, where the coordinates themselves are rounded to 1e-9 m.
  Points moved = square, far_diamond = diamond;
  for (Points* ring : {&moved, &far_diamond})
    for (Vec2& v : *ring) v += Vec2{4.5e6, 5.3e6};
  EXPECT_NEAR(split_area(moved, far_diamond).inside, 1.0, 1e-8);
}

/// A random bed of up to 5 vertices, and an outline whose base follows it, `raised` above it.
struct Ground {
  Points bed, outline;

  Ground(std::mt19937& random, double raised) {
    const auto u = [&](double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(random); };
    const int segments = 1 + static_cast<int>(u(0.0, 4.0));
    for (int k = 0; k <= segments; ++k) bed.push_back({100.0 * k / segments, u(0.0, 60.0 / segments)});
    for (std::size_t k = 0; k < bed.size(); ++k) bed[k].y += 30.0 * static_cast<double>(bed.size() - k) / segments;
    const double from = u(1.0, 30.0), to = from + u(10.0, 50.0), thickness = u(3.0, 5.0);
    Points top;
    const auto add = [&](double x) {
      outline.push_back({x, height(x) + raised});
      top.push_back({x, height(x) + thickness});
    };
    add(from);
    for (const Vec2& v : bed)
      if (v.x > from && v.x < to) add(v.x);
    add(to);
    outline.insert(outline.end(), top.rbegin(), top.rend());
  }
  double height(double x) const {
    std::size_t k = 1;
    while (bed[k].x < x) ++k;
    return height_at(bed[k - 1], bed[k], x);
  }
  Json document() const {
    const auto list = [](const Points& points) {
      Json out = Json::array();
      for (const Vec2& v : points) out.push_back({v.x, v.y});
      return out;
    };
    return with("/terrain/bed_m", list(bed), with("/slide/outlines/0/outline_m", list(outline)));
  }
};

TEST(Trim, OutlinesWithTheirBaseOnTheBedAreKeptAsTheyAre) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 500; ++trial) {
    const Ground ground(random, 0.0);
    ASSERT_TRUE(faults_of(ground.document()).empty()) << trial << ": " << faults_of(ground.document())[0];
    EXPECT_EQ(load(ground.document()).value.model.slide[0].outline, ground.outline) << trial;
  }
}

TEST(Trim, ABaseInTheGroundIsCutAtTheBedOrRefused) {
  std::mt19937 random(6);
  for (int trial = 0; trial < 100; ++trial) {
    std::mt19937 same = random;
    const double slope_allowed = 0.2;  // of 0.25 m across the bed; what lies deeper vertically is less across
    const Ground sunk(random, -slope_allowed), on_bed(same, 0.0);
    const LoadedCase loaded = load(sunk.document());
    double kept = 0.0;
    for (const SlidePart& part : loaded.value.model.slide) kept += area(part.outline);
    EXPECT_NEAR(kept, area(on_bed.outline), 1e-4 * kept) << trial;
    const auto told = std::ranges::find_if(
        loaded.warnings, [](const Fault& w) { return w.message.find("in the ground, which are cut off") < 99; });
    EXPECT_NE(told, loaded.warnings.end()) << trial;
    std::mt19937 again = same;
    const auto faults = faults_of(Ground(again, -2.0).document());
    ASSERT_EQ(faults.size(), 1u) << trial;
    EXPECT_NE(faults[0].find("lies below the bed by "), std::string::npos) << faults[0];
  }
}

TEST(Trim, ABaseInTheGroundAddsNoMass) {
  // A block of 16 m by 5.5 m on a bed that falls by 1 in 2, half a metre across x in the rock: 16 * 5 above it.
  const Json document = with("/particle_spacing_m", 1.0,
                             with("/terrain/bed_m", {{0, 20}, {20, 10}, {60, 10}},
                                  with("/slide/outlines/0/outline_m", {{2, 18.5}, {18, 10.5}, {18, 16}, {2, 24}})));
  const LoadedCase loaded = load(document);
  const SlideMass mass = slide_mass(loaded.value.model, plan_particles(loaded.value.model));
  EXPECT_NEAR(mass.outline, 2000 * 16 * 5, 0.2);
  EXPECT_NEAR(mass.filled, mass.outline, 1e-6 * mass.outline);
  EXPECT_EQ(load(loaded.resolved).hash, loaded.hash) << "what is recorded is the outline as it was given";
  EXPECT_EQ(load(loaded.resolved).value.model, loaded.value.model);
}

TEST(Trim, TheOverlapOfTwoOutlinesCountsOnce) {
  Json document = test::minimal();
  document["slide"]["outlines"].push_back({{"outline_m", {{0, 7.95}, {4, 7.95}, {4, 9}, {0, 9}}}});
  const LoadedCase loaded = load(document);
  ASSERT_EQ(loaded.value.model.slide.size(), 2u);
  EXPECT_NEAR(area(loaded.value.model.slide[1].outline), 4.0, 1e-5) << "4 by 1.05 less 4 by 0.05";
  ASSERT_FALSE(loaded.warnings.empty());
  EXPECT_EQ(loaded.warnings.back().pointer, "/slide/outlines/1/outline_m");
  EXPECT_EQ(loaded.warnings.back().message,
            "has 0.2 m2 (4.76 %) in /slide/outlines/0/outline_m too, which are cut off");
}

TEST(Trim, NothingAboveTheBedIsRefused) {
  const auto faults = faults_of(with("/slide/outlines/0/outline_m", {{15, -0.2}, {35, -0.2}, {35, 0}, {15, 0}}));
  EXPECT_EQ(faults, std::vector<std::string>{"/slide: lies in the ground: less than one particle is left above the "
                                             "bed"});
}

/// Ground and slip surface of a slide of 18 m; the slip surface then follows the ground at a depth.
Json followed(double depth) {
  Json document = test::minimal();
  document["terrain"] = Json::object();
  document["slide"] = {{"ground_surface_m", {{0, 20}, {20, 10}, {60, 10}}},
                       {"slip_surface_m", {{2, 19}, {6, 12}, {14, 9.5}, {20, 10 - depth}, {60, 10 - depth}}}};
  return document;
}

TEST(Trim, AFilmIsLeftOutAndNamed) {
  const LoadedCase loaded = load(followed(0.01)), without = load(followed(0.0));
  const Model& model = loaded.value.model;
  // The slide ends where it is 0.25 m thick: 3.5 m at x = 14, 0.01 m at x = 20.
  const double end = 14.0 + 6.0 * (3.5 - 0.25) / (3.5 - 0.01);
  EXPECT_NEAR(bounding_box(model.slide).hi.x, end, 1e-4);
  const double film = 0.5 * (20.0 - end) * (0.25 + 0.01) + 40.0 * 0.01;
  EXPECT_NEAR(model.left_out, 2000 * film, 0.5);
  const SlideMass mass = slide_mass(model, plan_particles(model));
  EXPECT_NEAR(mass.outline - mass.filled, 2000 * film, 0.5) << "what was asked for is still told";
  ASSERT_FALSE(loaded.warnings.empty());
  EXPECT_EQ(loaded.warnings.back().pointer, "/slide");
  EXPECT_EQ(
      loaded.warnings.back().message.rfind("is thinner than half a particle spacing from x = 19.59 m to x = 60 m, "
                                           "0.0112 m on average: 0.454 m2 (",
                                           0),
      0u)
      << loaded.warnings.back().message;
  EXPECT_EQ(without.value.model.left_out, 0.0) << "a toe that ends within a few spacings is none";
  EXPECT_NEAR(bounding_box(without.value.model.slide).hi.x, 20.0, 1e-6);
}

TEST(Trim, AFilmThatCrossesTheGroundIsLeftOut) {
  Json document = followed(0.0);
  Json& slip = document["slide"]["slip_surface_m"];
  slip.erase(4);
  for (int x = 21; x <= 60; ++x) slip.push_back({x, 10.0 + (x % 2 == 0 ? 0.02 : -0.02)});  // lenses of 1 m
  EXPECT_LT(bounding_box(load(document).value.model.slide).hi.x, 20.01);
}

TEST(Trim, AThinSheetAndAThinLayerAreKept) {
  const Points sheet = {{15, 0}, {35, 0}, {35, 0.2}, {15, 0.2}};
  Json document = with("/slide/outlines/0/outline_m", {{15, 0}, {35, 0}, {35, 0.2}, {15, 0.2}});
  EXPECT_EQ(load(document).value.model.slide[0].outline, sheet) << "the slide is nothing else";
  document["slide"]["outlines"].push_back({{"outline_m", {{15, 0.2}, {35, 0.2}, {35, 3}, {15, 3}}}});
  EXPECT_EQ(load(document).value.model.slide[0].outline, sheet) << "a layer under others is no film";
}

TEST(BetweenSurfaces, HoldsTheAreaBetweenSurfacesThatMeetInParts) {
  std::mt19937 random(9);
  for (int trial = 0; trial < 300; ++trial) {
    const auto u = [&](double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(random); };
    Points ground, slip;
    double expected = 0.0, before = 0.0;
    for (int k = 0; k <= 12; ++k) {
      ground.push_back({7.3 * k, 60.0 - 4.0 * k + u(0.0, 3.0)});
      const double depth = u(0.0, 1.0) < 0.4 ? 0.0 : u(0.0, 5.0);
      slip.push_back({7.3 * k, ground.back().y - depth});
      if (k > 0) expected += 0.5 * 7.3 * (before + depth);
      before = depth;
    }
    EXPECT_NEAR(total_area(between_surfaces(ground, slip)), expected, 1e-4 * (1.0 + expected)) << trial;
  }
}

}  // namespace
}  // namespace talus
