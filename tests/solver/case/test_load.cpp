#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <iomanip>
#include <numbers>
#include <sstream>

#include "case/load.hpp"
#include "documents.hpp"
#include "math/angle.hpp"

namespace talus {
namespace {

using test::faults_of;
using test::minimal;
using test::with;

TEST(LoadCase, DefaultsAreThoseOfTheStructs) {
  const Case c = test::load(minimal()).value;
  EXPECT_EQ(c.model.rheology, Rheology{});
  Numerics numerics;
  numerics.integrator = Integrator::leapfrog;  // of this law, density filter and step
  EXPECT_EQ(c.model.numerics, numerics);
  EXPECT_EQ(c.model.walls, Walls{});
  EXPECT_EQ(c.study, StudySpec{});
  EXPECT_EQ(c.model.g, Model{}.g);
  EXPECT_EQ(c.model.placement, Model{}.placement);
  EXPECT_EQ(c.model.lattice, Lattice{});
  EXPECT_EQ(c.model.max_particles, Model{}.max_particles);
  EXPECT_EQ(c.model.time.snapshots, TimeControl{}.snapshots);
  EXPECT_EQ(c.model.time.stop_at_rest, TimeControl{}.stop_at_rest);
  EXPECT_EQ(c.model.terrain.left_wall, Terrain{}.left_wall);
  EXPECT_EQ(c.model.terrain.right_wall, Terrain{}.right_wall);
  EXPECT_FALSE(c.field);
}

TEST(LoadCase, ConvertsDegreesToRadians) {
  Json document = with("/walls/slip", "friction", with("/walls/friction_angle_deg", 15));
  const Case c = test::load(document).value;
  EXPECT_NEAR(c.model.materials[0].phi, std::numbers::pi / 6, 1e-15);
  EXPECT_NEAR(c.model.boundaries.at(0).phi, std::numbers::pi / 12, 1e-15);
}

TEST(LoadCase, AWallHasTheSoilsCohesionUnlessItHasItsOwn) {
  Json document = with("/walls/slip", "friction", with("/walls/friction_angle_deg", 15));
  EXPECT_FALSE(test::load(document).value.model.boundaries.at(0).c);
  const LoadedCase own = test::load(with("/walls/cohesion_Pa", 0, document));
  EXPECT_EQ(own.value.model.boundaries.at(0).c, 0.0);
  EXPECT_NE(own.hash, test::load(document).hash);
  const LoadedCase slip = test::load(with("/walls/cohesion_Pa", 5, document));
  ASSERT_FALSE(slip.warnings.empty());
  EXPECT_EQ(slip.warnings.back().pointer, "/walls/cohesion_Pa");
}

TEST(LoadCase, TakesTheUnitsOfALaboratory) {
  Json document = minimal();
  document["material"] = {{"unit_weight_kN_m3", 19.62}, {"friction_angle_deg", 30}, {"cohesion_kPa", 5}};
  document["slide"]["outlines"][0]["material"] = {{"unit_weight_kN_m3", 9.81}, {"cohesion_kPa", 0.25}};
  const LoadedCase loaded = test::load(document);
  const auto& materials = loaded.value.model.materials;
  ASSERT_EQ(materials.size(), 2u);
  EXPECT_NEAR(materials[0].rho0, 19.62 * 1000 / 9.81, 1e-9);
  EXPECT_EQ(materials[0].c, 5 * 1000.0);
  EXPECT_NEAR(materials[1].rho0, 1000.0, 1e-9);
  EXPECT_EQ(materials[1].c, 250.0);
  EXPECT_EQ(loaded.resolved["material"]["cohesion_Pa"], 5000.0);
  EXPECT_FALSE(loaded.resolved["material"].contains("cohesion_kPa"));
  EXPECT_FALSE(loaded.resolved["material"].contains("unit_weight_kN_m3"));
  EXPECT_EQ(test::load(with("/gravity_m_s2", 98.1, document)).value.model.materials, materials)
      << "a unit weight is stated at 9.81 m/s2, whatever the centrifuge does";
}

TEST(LoadCase, RefusesAValueInTwoUnits) {
  const auto both = [](const char* at, const char* key, const char* other) {
    Json document = with("/slide/outlines/0/material", {{"name", "layer"}});
    document[Json::json_pointer(at)][key] = 1900;
    document[Json::json_pointer(at)][other] = 19;
    return faults_of(document);
  };
  for (const char* at : {"/material", "/slide/outlines/0/material"}) {
    EXPECT_EQ(both(at, "density_kg_m3", "unit_weight_kN_m3"),
              std::vector{at + std::string("/unit_weight_kN_m3: is given beside density_kg_m3; give one of the two")});
    EXPECT_EQ(both(at, "cohesion_Pa", "cohesion_kPa"),
              std::vector{at + std::string("/cohesion_kPa: is given beside cohesion_Pa; give one of the two")});
  }
  EXPECT_EQ(
      faults_of(with("/material", {{"friction_angle_deg", 30}})),
      std::vector<std::string>{"/material/density_kg_m3: is missing (or unit_weight_kN_m3); unit kg/m3, allowed >= "
                               "1 and <= 1e+05"});
}

const Json grains = Json::parse(
    R"({"high_rate_friction_angle_deg": 38, "reference_inertial_number": 0.3, "grain_diameter_m": 0.004,
        "grain_density_kg_m3": 2700, "high_rate_slope": 0.02})");

TEST(LoadCase, MuIReachesItsMembersWithTheFrictionThatItAdds) {
  const Material m = test::load(with("/material/mu_i", grains)).value.model.materials[0];
  const double rise = std::tan(radians(38)) - std::tan(radians(30));
  EXPECT_EQ(m.mu_i, (InertialFriction<>{rise, 0.3, 0.02, 0.004, 2700}));
  EXPECT_EQ(m.eta, 0.0);
  const LoadedCase in_mm =
      test::load(with("/material/mu_i", {{"high_rate_friction_angle_deg", 38}, {"grain_diameter_mm", 4}}));
  EXPECT_EQ(in_mm.value.model.materials[0].mu_i, (InertialFriction<>{rise, 0.279, 0.05, 0.004, 2650}));
  EXPECT_EQ(in_mm.resolved["material"]["mu_i"]["grain_diameter_m"], 0.004);
}

TEST(LoadCase, ALayerStatesItsOwnRateDependenceOrInheritsIt) {
  Json base = with("/slide/outlines/0/material", {{"friction_angle_deg", 35}});
  const auto layer_of = [](const Json& document) {
    const LoadedCase loaded = test::load(document), again = test::load(loaded.resolved);
    EXPECT_EQ(loaded.hash, again.hash) << "the resolved case is a case, and the same one";
    EXPECT_EQ(loaded.value.model.materials, again.value.model.materials);
    return loaded.value.model.materials.at(1);
  };
  base["material"]["mu_i"] = grains;
  EXPECT_EQ(layer_of(base).mu_i->delta_mu, std::tan(radians(38)) - std::tan(radians(35)));
  EXPECT_EQ(layer_of(base).mu_i->d, 0.004);
  base["slide"]["outlines"][0]["material"]["viscosity_Pa_s"] = 0;
  EXPECT_FALSE(layer_of(base).mu_i);
  base["material"].erase("mu_i");
  base["material"]["viscosity_Pa_s"] = 70;
  base["slide"]["outlines"][0]["material"] = {{"mu_i", grains}};
  EXPECT_EQ(layer_of(base).eta, 0.0);
  EXPECT_EQ(layer_of(base).mu_i->d, 0.004);
}

TEST(LoadCase, RefusesMuIThatContradictsTheRest) {
  const auto faults = [](const char* at, Json value, Json document) {
    return faults_of(with(at, std::move(value), std::move(document)));
  };
  const Json flowing = with("/material/mu_i", grains);
  EXPECT_EQ(faults("/material/viscosity_Pa_s", 5, flowing),
            std::vector<std::string>{"/material/mu_i: is given beside viscosity_Pa_s; give one of the two"});
  EXPECT_EQ(faults("/material/friction_angle_deg", 38, flowing),
            std::vector<std::string>{"/material/mu_i/high_rate_friction_angle_deg: 38 does not exceed "
                                     "friction_angle_deg, 38; friction grows with the shear rate"});
  EXPECT_EQ(faults("/slide/outlines/0/material", {{"friction_angle_deg", 40}}, flowing),
            std::vector<std::string>{
                "/slide/outlines/0/material/friction_angle_deg: 40 is not less than high_rate_friction_angle_deg of "
                "the default material's mu_i, 38; give this layer a mu_i of its own"});
  EXPECT_EQ(faults("/rheology/shear_rate", "paper", flowing),
            std::vector<std::string>{
                "/rheology/shear_rate: \"paper\" is the norm of [Z20] Eq. 7, with which mu(I) is not defined; "
                "material mu_i needs \"consistent\""});
  EXPECT_EQ(faults("/material/mu_i/grain_diameter_mm", 4, flowing),
            std::vector<std::string>{
                "/material/mu_i/grain_diameter_mm: is given beside grain_diameter_m; give one of the two"});
  EXPECT_EQ(faults("/material/mu_i", Json::object(), minimal()),
            (std::vector<std::string>{
                "/material/mu_i/high_rate_friction_angle_deg: is missing; unit deg, allowed >= 0 and <= 89",
                "/material/mu_i/grain_diameter_m: is missing (or grain_diameter_mm); unit m, allowed > 0 and <= 10"}));
}

TEST(LoadCase, EveryNumberReachesItsMember) {
  Json document =
      with("/material",
           Json::parse(R"({"name":"m","density_kg_m3":1,"friction_angle_deg":2,"cohesion_Pa":3,"viscosity_Pa_s":4})"));
  document["gravity_m_s2"] = 5;
  document["terrain"]["front_thickness_m"] = 0.75;
  document["particle_lattice"] = {{"shift_x_spacings", 0.25}, {"shift_y_spacings", 0.5}, {"angle_deg", 45}};
  document["rheology"] = {
      {"shear_rate", "paper"}, {"yield", "regularized"}, {"min_shear_rate_1_s", 6}, {"shear_modulus_Pa", 7}};
  document["numerics"] = {{"kernel", "wendland_c2"},
                          {"smoothing_ratio", 1.25},
                          {"sound_speed_m_s", 8},
                          {"artificial_viscosity_alpha", 9},
                          {"artificial_viscosity_beta", 10},
                          {"artificial_viscosity_jump", "reconstructed"},
                          {"continuity", "mass"},
                          {"density_filter", "delta_sph"},
                          {"filter_interval_steps", 11},
                          {"delta_sph_coefficient", 0.12},
                          {"tension_cutoff", false},
                          {"initial_pressure", "stress_free"},
                          {"integrator", "leapfrog"},
                          {"precision", "double"},
                          {"cfl", 0.13}};
  document["walls"] = {{"contact", "approaching"}, {"slip", "free_slip"}, {"max_velocity_ratio", 14}, {"layers", 15}};
  document["time"] = {{"end_s", 16},
                      {"max_step_s", 17},
                      {"snapshots_exact", true},
                      {"stop_at_rest", {{"speed_m_s", 18}, {"hold_s", 19}}}};
  const Model m = test::load(document).value.model;
  EXPECT_EQ(m.materials[0], (Material{"m", 1, 2 * std::numbers::pi / 180, 3, 4}));
  EXPECT_EQ(m.g, (Vec2{0, -5}));
  EXPECT_EQ(m.terrain.front_thickness, 0.75);
  EXPECT_EQ(m.lattice, (Lattice{{0.25, 0.5}, std::numbers::pi / 4}));
  EXPECT_EQ(m.rheology, (Rheology{ShearRate::paper, Yield::regularized, 6, 7.0}));
  EXPECT_EQ(m.numerics, (Numerics{KernelShape::wendland_c2, 1.25, 8.0, 9, VelocityJump::reconstructed, 10,
                                  Continuity::mass, DensityFilter::delta_sph, 11, 0.12, false,
                                  InitialPressure::stress_free, Integrator::leapfrog, Precision::full, 0.13}));
  EXPECT_EQ(m.walls, (Walls{WallContact::approaching, 14, 15}));
  EXPECT_EQ(m.boundaries.at(0).slip, WallSlip::free_slip);
  EXPECT_EQ(m.time, (TimeControl{16, {}, 17.0, {}, true, StopAtRest{18, 19}}));
}

TEST(LoadCase, FieldAndStudyReachTheirMembers) {
  Json document = minimal();
  document["random_field"] = {{"correlation_length_x_m", 1},
                              {"correlation_length_y_m", 2},
                              {"log_mean", -0.3},
                              {"log_stdev", -0.4},
                              {"direction", "y"},
                              {"sampler", "circulant_embedding"},
                              {"truncation", "diagonal"},
                              {"terms", 6},
                              {"variance_share", 0.7},
                              {"root_intervals", "paper"},
                              {"cell_average", true},
                              {"domain_m", {{"x", {8, 9}}, {"y", {10, 11}}}},
                              {"xi", {12, -13}},
                              {"grid_spacing_m", 14}};
  document["study"] = {{"realizations", 1},           {"seed", 2},
                       {"noise_floor_replicates", 3}, {"sampling", "latin_hypercube"},
                       {"stratified_modes", 4},       {"stop_when_ci_half_width_below_m", 5},
                       {"max_failed_share", 0.6},     {"histogram_edges_m", {7, 8}}};
  const Case c = test::load(document).value;
  FieldSpec f{FieldDirection::y,
              1,
              2,
              -0.3,
              {},
              -0.4,
              FieldSampler::circulant_embedding,
              Truncation::diagonal,
              6,
              0.7,
              RootIntervals::paper,
              true,
              Box{{8, 10}, {9, 11}},
              {12, -13},
              14.0};
  EXPECT_EQ(c.field, f);
  EXPECT_EQ(c.study, (StudySpec{1, 2, 3, Sampling::latin_hypercube, 4, 5.0, 0.6, {7, 8}}));
}

TEST(LoadCase, MeanIsKeptAndCovBecomesTheLogStdev) {
  const auto field = [](Json section) { return *test::load(with("/random_field", std::move(section))).value.field; };
  const double cov = 0.3, mean = 0.5, sigma2 = std::log(1 + cov * cov);
  const FieldSpec both = field({{"correlation_length_m", 1}, {"mean_tan_phi", mean}, {"cov_tan_phi", cov}});
  EXPECT_NEAR(both.sigma, std::sqrt(sigma2), 1e-15);
  EXPECT_EQ(both.mean, mean);
  EXPECT_FALSE(both.mu) << "it follows from the mean at each particle";
  const FieldSpec spread = field({{"correlation_length_m", 1}, {"cov_tan_phi", cov}});
  EXPECT_EQ(spread.sigma, both.sigma);
  EXPECT_FALSE(spread.mu || spread.mean) << "the median is the material's";
  EXPECT_EQ(spread.ell_x, 1.0);
  EXPECT_EQ(spread.ell_y, 1.0);
}

TEST(LoadCase, DerivedDefaultsOfTheTerrain) {
  const Terrain t = test::load(with("/terrain/bed_m", {{-1, 5.5}, {10, 0}, {40, 0}})).value.model.terrain;
  EXPECT_EQ(t.run_out.from, -1.0);
  EXPECT_EQ(t.wall_top, 8.0 + 5 * 0.5) << "over the slide";
  EXPECT_EQ(t.front_thickness, 1.5 * 0.5);
  EXPECT_EQ(test::load(with("/particle_spacing_m", 0.05)).value.model.terrain.front_thickness, 0.1);
  const Terrain high = test::load(with("/terrain/bed_m", {{-9, 20}, {0, 5}, {10, 0}, {40, 0}})).value.model.terrain;
  EXPECT_EQ(high.wall_top, 20.0 + 5 * 0.5) << "over the bed where a wall stands";
}

TEST(LoadCase, EndWallsMayHaveTopsOfTheirOwn) {
  const Json walled = with("/terrain/right_end", "wall");
  const auto terrain = [](const Json& document) { return test::load(document).value.model.terrain; };
  const Terrain both = terrain(with("/terrain/wall_top_m", 12, walled));
  EXPECT_EQ(both.left_wall_top(), 12.0);
  EXPECT_EQ(both.right_wall_top(), 12.0);
  const Json low = with("/terrain/right_wall_top_m", 1.5, walled);
  EXPECT_EQ(terrain(low).left_wall_top(), 8.0 + 5 * 0.5);
  EXPECT_EQ(terrain(low).right_wall_top(), 1.5);
  EXPECT_EQ(terrain(with("/terrain/left_wall_top_m", 9, low)).left_wall_top(), 9.0);
  const std::vector<Vec2> line = test::load(low).value.model.boundaries.at(0).line.vertices;
  EXPECT_EQ(line.front().y, 8.0 + 5 * 0.5);
  EXPECT_EQ(line.back().y, 1.5);
  const auto fault = [](const Json& document) {
    try {
      test::load(document);
    } catch (const ConfigError& e) {
      return e.faults.size() == 1 ? e.faults[0].pointer + ": " + e.faults[0].message : std::string("several");
    }
    return std::string();
  };
  EXPECT_EQ(fault(with("/terrain/right_wall_top_m", 0, walled)),
            "/terrain/right_wall_top_m: 0 does not lie above the bed at the walled end, y = 0");
  EXPECT_EQ(fault(with("/terrain/left_wall_top_m", 5, walled)),
            "/terrain/left_wall_top_m: 5 does not lie above the bed at the walled end, y = 5");
  EXPECT_EQ(fault(with("/terrain/right_wall_top_m", 9)),
            "/terrain/right_wall_top_m: has no meaning: no wall stands on the right end");
  EXPECT_EQ(fault(with("/terrain/wall_top_m", 4, with("/terrain/left_wall_top_m", 9, walled))), "")
      << "wall_top_m is then the right wall's";
}

TEST(LoadCase, ClosedBedsRunCounterClockwiseWithoutRepetition) {
  Json document = with("/terrain", Json::parse(R"({"bed_m": [[0,0],[0,9],[20,9],[20,0],[0,0]], "closed": true})"));
  document["slide"]["outlines"][0]["outline_m"] = {{0, 0}, {5, 0}, {5, 5}, {0, 5}, {0, 0}};
  const Model m = test::load(document).value.model;
  EXPECT_EQ(m.terrain.bed, (std::vector<Vec2>{{20, 0}, {20, 9}, {0, 9}, {0, 0}}));
  EXPECT_EQ(m.terrain.run_out.from, 0.0);
  EXPECT_EQ(m.slide[0].outline.size(), 4u);
}

TEST(LoadCase, LayersOverrideTheDefaultMaterialInPart) {
  Json document = with("/slide/outlines/0/material", {{"cohesion_Pa", 700}});
  document["slide"]["outlines"].push_back(
      {{"outline_m", {{0, 8}, {5, 8}, {5, 9}, {0, 9}}}, {"material", {{"cohesion_Pa", 700}}}});
  const Model m = test::load(document).value.model;
  ASSERT_EQ(m.materials.size(), 2u) << "one for both layers";
  EXPECT_EQ(m.slide[0].material, 1);
  EXPECT_EQ(m.slide[1].material, 1);
  EXPECT_EQ(m.materials[1].c, 700.0);
  EXPECT_EQ(m.materials[1].rho0, m.materials[0].rho0);
  EXPECT_EQ(m.materials[1].phi, m.materials[0].phi);
}

TEST(LoadCase, SnapshotsAtAnIntervalLieInside) {
  const auto times = [](double end, double interval) {
    return test::load(with("/time", {{"end_s", end}, {"snapshot_interval_s", interval}})).value.model.time.snapshots;
  };
  EXPECT_EQ(times(5, 2), (std::vector<double>{2, 4}));
  EXPECT_EQ(times(6, 2), (std::vector<double>{2, 4}));
  EXPECT_EQ(times(0.3, 0.1).size(), 2u) << "3 * 0.1 exceeds 0.3 by rounding only";
  EXPECT_EQ(faults_of(with("/time", {{"end_s", 5}, {"snapshot_interval_s", 1e-6}})).size(), 1u);
}

TEST(LoadCase, CollectsTheFaultsOfAllSections) {
  Json document = minimal();
  document.erase("title");
  document["material"]["cohesion_Pa"] = "5 kPa";
  document["material"]["friction_angle"] = 30;
  document["terrain"]["bed_m"][1] = {-1, 0};
  document["study"] = {{"seed", -1}};
  const auto faults = faults_of(document);
  ASSERT_EQ(faults.size(), 5u);
  EXPECT_EQ(faults[1], "/material/cohesion_Pa: \"5 kPa\" is not a number; unit Pa, allowed >= 0 and <= 1e+09");
  EXPECT_EQ(faults[2], "/material/friction_angle: is not a known key (friction_angle_deg?)");
}

TEST(LoadCase, FileFromNowhereIsAnInputError) { EXPECT_THROW(load_case("/nonexistent/case.json"), IoError); }

TEST(CaseHash, FollowsWhatDecidesTheRuns) {
  const std::string hash = test::load(minimal()).hash;
  EXPECT_EQ(hash.size(), 16u);
  EXPECT_EQ(test::load(with("/title", "other")).hash, hash);
  EXPECT_EQ(test::load(with("/description", "other")).hash, hash);
  EXPECT_EQ(test::load(with("/study", {{"realizations", 7}, {"seed", 3}, {"histogram_edges_m", {1, 2}}})).hash, hash);
  EXPECT_EQ(test::load(with("/particle_spacing_m", 0.5)).hash, hash);
  EXPECT_EQ(test::load(with("/numerics/cfl", Numerics{}.cfl)).hash, hash) << "a default spelt out";
  EXPECT_EQ(test::load(with("/particle_lattice", {{"angle_deg", 0}})).hash, hash);
  EXPECT_NE(test::load(with("/particle_lattice", {{"angle_deg", 15}})).hash, hash);
  EXPECT_NE(test::load(with("/numerics/cfl", 0.2)).hash, hash);
  EXPECT_NE(test::load(with("/study/sampling", "latin_hypercube")).hash, hash);
  EXPECT_NE(test::load(with("/material/friction_angle_deg", 30.000001)).hash, hash);
}

TEST(CaseHash, IsFnv1a) {
  // FNV-1a of the two bytes "{}" by the published recurrence (Fowler, Noll, Vo; offset 14695981039346656037, prime
  // 1099511628211).
  const auto step = [](std::uint64_t h, unsigned char c) { return (h ^ c) * 1099511628211ULL; };
  std::ostringstream expected;
  expected << std::hex << std::setw(16) << std::setfill('0') << step(step(14695981039346656037ULL, '{'), '}');
  EXPECT_EQ(case_hash(Json::object()), expected.str());
  EXPECT_EQ(case_hash({{"a", 1}, {"b", 2}}), case_hash({{"b", 2}, {"a", 1}}));
}

/// A case whose slide lies on a bed that is given.
Json on_bed(const char* bed, const char* outline, const Json& more = Json::object()) {
  Json document = minimal();
  document["terrain"] = {{"bed_m", Json::parse(bed)}};
  document["terrain"].update(more);
  document["slide"] = {{"outlines", {{{"outline_m", Json::parse(outline)}}}}};
  document["particle_spacing_m"] = 0.25;
  return document;
}

constexpr const char* falls_left = "[[-60,0],[-14,0],[0,8]]";
constexpr const char* on_the_slope = "[[-14,0],[0,8],[0,10],[-14,2]]";

TEST(LoadCase, TheSlideGoesWhereTheBedFalls) {
  const Terrain left = test::load(on_bed(falls_left, on_the_slope)).value.model.terrain;
  EXPECT_EQ(left.run_out, (RunOutAxis{0.0, SlidesTo::left}));
  EXPECT_FALSE(left.left_wall);
  EXPECT_TRUE(left.right_wall);
  const Terrain right =
      test::load(on_bed("[[-1,8],[14,0],[60,0]]", "[[0,8],[14,0],[14,2],[0,10]]")).value.model.terrain;
  EXPECT_EQ(right.run_out, (RunOutAxis{-1.0, SlidesTo::right}));
  EXPECT_TRUE(right.left_wall);
  EXPECT_FALSE(right.right_wall);
}

TEST(LoadCase, OnLevelGroundTheSlideGoesAwayFromTheWall) {
  const char* bed = "[[0,1],[20,1]]";
  const auto to = [&](const char* outline, const Json& ends) {
    return test::load(on_bed(bed, outline, ends)).value.model.terrain.run_out.to;
  };
  const char* at_the_right = "[[15,1],[20,1],[20,4],[15,4]]";
  EXPECT_EQ(to(at_the_right, {{"right_end", "wall"}}), SlidesTo::left);
  EXPECT_EQ(to(at_the_right, {{"right_end", "open"}}), SlidesTo::right);
  EXPECT_EQ(to("[[0,1],[20,1],[20,4],[0,4]]", {{"right_end", "wall"}}), SlidesTo::right);
  EXPECT_EQ(to("[[5,1],[9,1],[9,4],[5,4]]", {{"right_end", "wall"}}), SlidesTo::right);
}

TEST(LoadCase, TheDirectionAndWhereItIsMeasuredFromCanBeGiven) {
  const Terrain t = test::load(on_bed(falls_left, on_the_slope, {{"slides_to", "right"}, {"measured_from_m", -14}}))
                        .value.model.terrain;
  EXPECT_EQ(t.run_out, (RunOutAxis{-14.0, SlidesTo::right}));
  EXPECT_EQ(faults_of(on_bed(falls_left, on_the_slope, {{"slides_to", "up"}})).size(), 1u);
}

}  // namespace
}  // namespace talus
