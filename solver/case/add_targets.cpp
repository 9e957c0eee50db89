// Targets on the ground: whether they can stand where they are, and what the flow sees of them.

#include <algorithm>
#include <cmath>

#include "case/outline.hpp"
#include "case/overlay.hpp"
#include "case/sections.hpp"
#include "particles/geometry.hpp"
#include "simulation/flow_at.hpp"
#include "simulation/reach.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

/// Of the targets of one case, in their order.
class TargetBuilder {
 public:
  TargetBuilder(Model& model, Faults& faults) : model_(model), terrain_(model.terrain), faults_(faults) {}

  void add(const TargetInput& input) {
    const auto same = std::ranges::find(model_.targets, input.name, [](const Target& t) { return t.of.name; });
    if (same != model_.targets.end())
      fault(input, "name",
            "is that of /targets/" + std::to_string(same - model_.targets.begin()) +
                " too; give each target a name of its own");
    Target target{.of = {input.name, input.kind}, .threshold = terrain_.front_thickness};
    const std::size_t before = faults_.size();
    if (input.kind == TargetKind::structure)
      add_structure(input, target);
    else
      place(input, target);
    if (faults_.size() == before) model_.targets.push_back(std::move(target));
  }

 private:
  void fault(const TargetInput& input, const std::string& key, const std::string& message) {
    faults_.add(input.pointer + "/" + key, message);
  }
  double ground_at(double x) const { return height_beneath(terrain_.bed, {x, 1e9}); }

  /// A place on the terrain, and not on the slide. @param key  of the target that says where it is
  bool check_extent(const TargetInput& input, const std::string& key, double from, double to) {
    const auto [left, right] = std::ranges::minmax(terrain_.bed, {}, &Vec2::x);
    if (from < left.x || to > right.x) {
      fault(input, key, "lies off the terrain, which reaches from x = " + to_text(left.x) + " to " + to_text(right.x));
      return false;
    }
    for (const SlidePart& part : model_.slide) {
      const auto [low, high] = std::ranges::minmax(part.outline, {}, &Vec2::x);
      if (to < low.x || from > high.x) continue;
      fault(input, key,
            "lies on the slide, which reaches from x = " + to_text(low.x) + " to " + to_text(high.x) +
                "; a target is a place that the slide may reach");
      return false;
    }
    return true;
  }

  void place(const TargetInput& input, Target& target) {
    const bool point = input.kind == TargetKind::point;
    const char* key = point ? "point_m" : "stretch_m";
    target.from = input.x.front();
    target.to = point ? target.from : input.x.back();
    if (!point && target.from >= target.to) {
      fault(input, key, "has no extent: give [x1, x2] with x1 < x2");
      return;
    }
    if (!check_extent(input, key, target.from, target.to) || !point || input.x.size() < 2) return;
    const double above = input.x[1] - ground_at(target.from);
    if (above < -0.5 * model_.dx)
      fault(input, key,
            "lies " + rounded(-above) + " m below the ground, whose height there is " +
                to_text(ground_at(target.from)) + "; half a particle spacing is tolerated");
    target.threshold = std::max(target.threshold, above);
  }

  /// The outline of a structure that is given by its faces: from below the ground to its top.
  std::vector<Vec2> upright(const TargetInput& input) {
    const double left = input.x[0], right = input.x[1];
    double highest = std::max(ground_at(left), ground_at(right)), lowest = std::min(ground_at(left), ground_at(right));
    for (const Vec2& v : terrain_.bed) {
      if (v.x <= left || v.x >= right) continue;
      highest = std::max(highest, v.y);
      lowest = std::min(lowest, v.y);
    }
    const double top = highest + *input.height, bottom = lowest - model_.walls.layers * model_.dx;
    return {{left, bottom}, {left, top}, {right, top}, {right, bottom}};
  }

  /// The part of an outline above the ground; nothing and a fault unless it is one piece that stands on it.
  std::optional<std::vector<Vec2>> above_ground(const TargetInput& input, const std::vector<Vec2>& outline) {
    const double top = std::ranges::max(outline, {}, &Vec2::y).y;
    const auto pieces = pieces_inside(outline, room_above(terrain_.bed, top));
    if (!pieces || pieces->size() > 1) {
      fault(input, "structure", "is cut into several pieces by the ground; give each as a target of its own");
      return std::nullopt;
    }
    if (pieces->empty() || area(pieces->front()) < 1e-9 * area(outline)) {
      fault(input, "structure", "lies in the ground");
      return std::nullopt;
    }
    return pieces->front();
  }

  void add_structure(const TargetInput& input, Target& target) {
    const bool by_faces = input.outline.empty();
    const std::string key = by_faces ? "structure/x_m" : "structure/outline_m";
    if (terrain_.closed) {
      fault(input, "structure", "needs an open bed");
      return;
    }
    if (by_faces && input.x[0] >= input.x[1]) {
      fault(input, key, "has no extent: give [low, high] with low < high");
      return;
    }
    if (!by_faces && self_intersection(input.outline.points, true)) {
      fault(input, key, "crosses or touches itself");
      return;
    }
    const Polyline ring{by_faces ? std::vector<Vec2>{{input.x[0], 0}, {input.x[1], 0}} : input.outline.points, true};
    const auto [low, high] = std::ranges::minmax(ring.vertices, {}, &Vec2::x);
    if (!check_extent(input, key, low.x, high.x)) return;
    std::vector<Vec2> outline = by_faces ? upright(input) : input.outline.points;
    if (signed_area(outline) > 0.0) std::ranges::reverse(outline);  // the soil is outside
    const auto above = above_ground(input, outline);
    if (above) stand(input, key, std::move(outline), *above, target);
  }

  /// @param outline  clockwise; @param above  its part above the ground
  void stand(const TargetInput& input, const std::string& key, std::vector<Vec2> outline,
             const std::vector<Vec2>& above, Target& target) {
    std::vector<Vec2> feet;
    const double touches = 1e-3 * model_.dx;  // of the overlay, which rounds
    for (const Vec2& v : above)
      if (std::abs(v.y - height_beneath(terrain_.bed, {v.x, v.y + touches})) < touches) feet.push_back(v);
    if (feet.empty()) {
      fault(input, "structure", "hangs above the ground; let its outline reach down to it");
      return;
    }
    Box box{above.front(), above.front()};
    for (const Vec2& v : above) box.include(v);
    const double width = area(above) / box.height(), least = model_.walls.layers * model_.dx;
    if (box.height() < model_.dx)
      fault(input, "structure",
            "rises " + rounded(box.height()) + " m above the ground, less than one particle spacing of " +
                to_text(model_.dx));
    if (width < least * (1.0 - 1e-9))
      fault(input, key,
            "makes a structure " + rounded(width) + " m wide; the particles see one of at least " + to_text(least) +
                " m (walls.layers particle spacings), or use a smaller spacing");
    for (std::size_t k = 1; k < model_.boundaries.size(); ++k)
      if (shared_area(model_.boundaries[k].line.vertices, outline) > 0.0)
        fault(input, "structure", "overlaps the structure " + in_quotes(model_.boundaries[k].name));
    const bool to_right = terrain_.run_out.to == SlidesTo::right;
    const double face = to_right ? box.lo.x : box.hi.x, before = target_reach(model_.dx);
    target.from = target.to = to_right ? face - before : face + before;
    const auto [first, last] = std::ranges::minmax(feet, {}, &Vec2::x);
    target.structure = {.boundary = static_cast<int>(model_.boundaries.size()), .foot = to_right ? last : first};
    averaging_.push_back(input.averaging);
    Boundary boundary = model_.boundaries.front();
    boundary.name = input.name;
    boundary.line = {std::move(outline), true};
    model_.boundaries.push_back(std::move(boundary));
  }

 public:
  /// The averaging times, of which the default depends on the fall height.
  void set_averaging() {
    constexpr double share = 0.05;
    auto given = averaging_.begin();
    for (Target& target : model_.targets)
      if (target.structure)
        target.structure->averaging =
            (*given++).value_or(share * std::sqrt(2.0 * fall_height(model_) / norm(model_.g)));
  }

 private:
  Model& model_;
  const Terrain& terrain_;
  Faults& faults_;
  std::vector<std::optional<double>> averaging_;  ///< of the structures [s]
};

}  // namespace

void add_targets(Model& model, const SourceLocations& origins, Faults& faults) {
  TargetBuilder builder(model, faults);
  for (const TargetInput& input : origins.targets) builder.add(input);
  if (faults.empty()) builder.set_averaging();
}

}  // namespace talus
