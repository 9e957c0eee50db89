#include <algorithm>
#include <cmath>
#include <limits>

#include "case/outline.hpp"
#include "case/overlay.hpp"
#include "case/sections.hpp"
#include "particles/geometry.hpp"
#include "particles/ground.hpp"
#include "simulation/particle_setup.hpp"
#include "simulation/reach.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

void check_apart(const Model& model, const SourceLocations& origins, Faults& faults) {
  for (std::size_t a = 0; a < model.slide.size(); ++a)
    for (std::size_t b = a + 1; b < model.slide.size(); ++b)
      if (const double shared = shared_area(model.slide[a].outline, model.slide[b].outline);
          shared > model.dx * model.dx)
        faults.add(origins.outlines[b].source,
                   "overlaps " + origins.outlines[a].source + " by " + rounded(shared) + " m2");
}

/// A section that no computation fits: most often one vertex with another unit or another grid.
bool check_extent(const Model& model, const SourceLocations& origins, Faults& faults) {
  Box all = bounding_box(model.slide);
  for (const Vec2& v : model.terrain.bed) all.include(v);
  if (std::max(all.width(), all.height()) <= largest_extent) return true;
  faults.add(origins.bed.source, "and the slide extend over " + rounded(all.width()) + " m along x and " +
                                     rounded(all.height()) + " m along y; at most " + rounded(largest_extent) +
                                     " m are allowed");
  return false;
}

/// An open bed: the soil needs ground beneath it from one end to the other.
bool check_between_ends(const SlidePart& part, const Vertices& origin, const Terrain& terrain, Faults& faults) {
  const double left = terrain.bed.front().x, right = terrain.bed.back().x;
  for (std::size_t k = 0; k < part.outline.size(); ++k) {
    const Vec2 v = part.outline[k];
    if (v.x >= left && v.x <= right) continue;
    const bool beyond_left = v.x < left;
    const bool wall = beyond_left ? terrain.left_wall : terrain.right_wall;
    faults.add(origin.points.size() == part.outline.size() ? origin.location(k) : origin.source,
               to_text(v) + " lies beyond the bed's " + (beyond_left ? "left" : "right") +
                   " end, x = " + to_text(beyond_left ? left : right) +
                   (wall ? ", where a wall stands" : ": soil there has no ground beneath it"));
    return false;
  }
  return true;
}

void check_on_ground(const SlidePart& part, const Vertices& origin, const Model& model, Faults& faults) {
  const Terrain& terrain = model.terrain;
  if (!terrain.closed && !check_between_ends(part, origin, terrain, faults)) return;
  const double top = std::ranges::max(part.outline, {}, &Vec2::y).y;
  const Penetration in = reach_outside_ring(part.outline, terrain.closed ? terrain.bed : room_above(terrain.bed, top));
  if (in.depth > 0.5 * model.dx)
    faults.add(origin.source,
               std::string(terrain.closed ? "reaches out of the closed bed by " : "lies below the bed by ") +
                   rounded(in.depth) + " m at " + to_text(in.at) + "; half a particle spacing is tolerated");
}

void check_counts(const Model& model, Faults& faults) {
  const ParticleEstimate estimate = estimate_particles(model, wall_lines(model.boundaries, model.dx, model.placement));
  if (estimate.soil_area < model.dx * model.dx)
    faults.add("/particle_spacing_m", "leaves no particle: the slide's area, " + rounded(estimate.soil_area) +
                                          " m2, is less than one cell of " + rounded(model.dx * model.dx) + " m2");
  if (estimate.count(model.dx) <= static_cast<double>(model.max_particles)) return;
  const double fitting = estimate.spacing_for(static_cast<double>(model.max_particles));
  const Box slide = bounding_box(model.slide);
  const bool resolves = 5.0 * fitting <= std::min(slide.width(), slide.height());
  faults.add("/particle_spacing_m", "makes about " + rounded(estimate.count(model.dx)) +
                                        " particles, more than max_particles, " + std::to_string(model.max_particles) +
                                        "; a spacing from " + rounded(fitting) + " m on fits" +
                                        (resolves ? "" : ", but is too coarse for the slide: raise max_particles"));
}

/// Legal, but often two rows in the wrong order.
void warn_of_overhangs(const Terrain& terrain, std::vector<Fault>& warnings) {
  for (std::size_t k = 1; k < terrain.bed.size(); ++k) {
    const Vec2 from = terrain.bed[k - 1], to = terrain.bed[k];
    if (to.x >= from.x) continue;
    warnings.push_back({pointer_to("/terrain/bed_m", k),
                        "runs back from " + to_text(from) + " to " + to_text(to) +
                            ": rock hangs over there; if that is not meant, check the order of the vertices"});
    return;
  }
}

/// Least distance between the bed and points of the outlines, at most `step` apart [m].
double gap_above_bed(const Model& model, double step) {
  const Ground bed({{model.terrain.bed, model.terrain.closed}});
  double least = std::numeric_limits<double>::infinity();
  for (const SlidePart& part : model.slide) {
    const Polyline outline{part.outline, true};
    const auto points = static_cast<int>(std::ceil(outline.length() / step));
    for (int k = 0; k < points; ++k)
      least = std::min(least, std::abs(bed.nearest(outline.at(outline.length() * k / points)).distance));
  }
  return least;
}

/// Legal, but most often elevations from two surveys.
void warn_of_a_slide_in_the_air(const Model& model, std::vector<Fault>& warnings) {
  const double gap = gap_above_bed(model, model.dx);
  if (gap > model.dx)
    warnings.push_back({"/slide", "hangs " + rounded(gap) +
                                      " m above the bed, onto which it falls before it slides; if that is not meant, "
                                      "check the elevations of both"});
}

void warn_of_open_ends(const Model& model, std::vector<Fault>& warnings) {
  const Terrain& t = model.terrain;
  const EnergyLine line = energy_line(model);
  const bool stands = stands_by_cohesion(model);
  const auto check_end = [&](bool wall, Vec2 end, const char* pointer) {
    const double over = line.height(end.x) - end.y;
    if (!wall && !stands && over > 0.0)
      warnings.push_back({pointer, "may leak: the energy line at the friction angle passes " + rounded(over) +
                                       " m above the bed's end " + to_text(end) +
                                       "; soil that leaves is lost, so extend the bed or set a wall"});
  };
  check_end(t.left_wall, t.bed.front(), "/terrain/left_end");
  check_end(t.right_wall, t.bed.back(), "/terrain/right_end");
  const double highest = bounding_box(model.slide).hi.y;
  const auto check_top = [&](bool walled, std::optional<double> own, const std::string& pointer) {
    if (walled && highest > own.value_or(t.wall_top))
      warnings.push_back({own ? pointer : "/terrain/wall_top_m",
                          "is lower than the slide's highest point; soil may spill over the wall and is lost"});
  };
  check_top(t.left_wall, t.left_top, "/terrain/left_wall_top_m");
  const bool said = t.left_wall && !t.left_top && !t.right_top;  // one key, one warning
  check_top(t.right_wall && !said, t.right_top, "/terrain/right_wall_top_m");
}

/// Keys that the choices of sampler and truncation leave unused. A resolved case names every key, so only a value other
/// than the default shows that it was meant.
void warn_of_unused_keys(const FieldSpec& f, std::vector<Fault>& warnings) {
  const FieldSpec defaults;
  const bool expanded = f.sampler == FieldSampler::karhunen_loeve;
  const bool by_share = expanded && f.truncation == Truncation::variance_share;
  const bool by_terms = expanded && f.truncation != Truncation::variance_share;
  const auto check_used = [&](const char* key, bool changed, bool used) {
    if (!changed || used) return;
    warnings.push_back({std::string("/random_field/") + key,
                        !expanded  ? "is not used: sampler is circulant_embedding, which truncates nothing"
                        : by_share ? "is not used: truncation is variance_share"
                                   : "is not used: truncation is not variance_share"});
  };
  check_used("terms", f.terms != defaults.terms, by_terms);
  check_used("variance_share", f.variance_share != defaults.variance_share, by_share);
  check_used("truncation", f.truncation != defaults.truncation, expanded);
  check_used("root_intervals", f.root_intervals != defaults.root_intervals, expanded);
  if (f.grid_spacing && expanded)
    warnings.push_back({"/random_field/grid_spacing_m", "is not used: sampler is karhunen_loeve"});
}

}  // namespace

void check_geometry(const Model& model, const SourceLocations& origins, Faults& faults) {
  if (!check_extent(model, origins, faults)) return;
  check_apart(model, origins, faults);
  for (std::size_t k = 0; k < model.slide.size(); ++k)
    check_on_ground(model.slide[k], origins.outlines[k], model, faults);
  check_counts(model, faults);
}

void check_choices(const Case& c, Faults& faults) {
  const double reach = 2.0 * c.model.numerics.h_over_dx - 0.5;  // of the support, from half a spacing above the wall
  if (c.model.walls.layers < reach)
    faults.add("/walls/layers", std::to_string(c.model.walls.layers) +
                                    " layers do not fill the kernel's support; smoothing_ratio " +
                                    to_text(c.model.numerics.h_over_dx) + " needs " + to_text(std::ceil(reach)));
  if (c.model.rheology.shear_rate == ShearRate::paper &&
      std::ranges::any_of(c.model.materials, [](const Material& m) { return m.mu_i.has_value(); }))
    faults.add(
        "/rheology/shear_rate",
        "\"paper\" is the norm of [Z20] Eq. 7, with which mu(I) is not defined; material mu_i needs \"consistent\"");
  for (std::size_t k = 0; k < c.model.materials.size(); ++k)
    if (c.model.rheology.yield == Yield::regularized && c.model.materials[k].softening)
      faults.add(material_pointer(c.model, k) + "/softening",
                 "needs rheology.yield \"elastic\": the regularized law shears everywhere and would soften at rest");
  if (!c.field) return;
  check_field_choices(c, faults);
}

void warn_of_thin_front(const Model& model, std::vector<Fault>& warnings) {
  if (model.terrain.front_thickness >= 1.5 * model.dx * (1.0 - 1e-9)) return;  // 0.6 m is enough for 0.4 m
  warnings.push_back({"/terrain/front_thickness_m",
                      to_text(model.terrain.front_thickness) + " m is less than 1.5 particle spacings, " +
                          rounded(1.5 * model.dx) +
                          " m: a single row of particles, which the method does not resolve, may decide where that "
                          "front is"});
}

std::vector<Fault> find_warnings(const Case& c) {
  std::vector<Fault> warnings;
  const Model& model = c.model;
  if (!model.terrain.closed) warn_of_overhangs(model.terrain, warnings);
  if (!model.terrain.closed) warn_of_open_ends(model, warnings);
  warn_of_a_slide_in_the_air(model, warnings);
  warn_of_thin_front(model, warnings);
  if (c.field) warn_of_unused_keys(*c.field, warnings);
  if (c.field) warn_of_undrained_layers(c, warnings);
  warn_of_unused_water(model, warnings);
  if (model.numerics.precision == Precision::full)
    warnings.push_back(
        {"/numerics/precision",
         "\"double\" takes the plain loops, about nine times slower than those of \"single\", which keep the "
         "state in double precision too"});
  if (c.study.sampling == Sampling::latin_hypercube && c.study.stop_half_width)
    warnings.push_back({"/study/stop_when_ci_half_width_below_m",
                        "cannot be kept: a Latin hypercube is one sample of a fixed size; talus study will refuse it"});
  return warnings;
}

}  // namespace talus
