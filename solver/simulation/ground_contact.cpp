#include "simulation/ground_contact.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace talus {

namespace {

constexpr std::size_t group = 512;  ///< particles whose actions are summed up in their order, by one thread

/// Adds impulses, of which there are as many or none.
void add(std::vector<WallLoad>& sum, const std::vector<WallLoad>& more) {
  if (sum.empty()) sum.resize(more.size());
  for (std::size_t s = 0; s < more.size(); ++s) sum[s] += more[s];
}

}  // namespace

GroundContact::GroundContact(std::vector<Polyline> lines, std::vector<WallFriction> friction, double dx, Vec2 g,
                             std::size_t particles, std::vector<Boundary> boundaries)
    : ground_(std::move(lines)),
      friction_(std::move(friction)),
      boundaries_(std::move(boundaries)),
      dx_(dx),
      g_(g),
      next_(particles, 0.0f),
      lost_(particles, 0),
      actions_((particles + group - 1) / group) {}

double GroundContact::act(Soil& soil, double displacement) {
  travelled_ += 1.0001 * displacement;  // found in single precision
#pragma omp parallel for schedule(static)
  for (std::size_t k = 0; k < actions_.size(); ++k)
    actions_[k] = act_on_some(soil, k * group, std::min((k + 1) * group, soil.n_active));
  double farthest = 0.0;
  impulses_.clear();
  for (const Action& action : actions_) {
    farthest = std::max(farthest, action.put_back);
    taken_ += action.taken;
    add(impulses_, action.impulses);
  }
  travelled_ += 2.0 * farthest;  // what was put back may be nearer to other ground
  return farthest;
}

/// Acts on the particles [begin, end) that may be in reach.
GroundContact::Action GroundContact::act_on_some(Soil& soil, std::size_t begin, std::size_t end) {
  Action all;
  for (std::size_t i = begin; i < end; ++i) {
    if (travelled_ < static_cast<double>(next_[static_cast<std::size_t>(soil.id[i])])) continue;
    const Action one = act_on(soil, i);
    all.put_back = std::max(all.put_back, one.put_back);
    all.taken += one.taken;
    add(all.impulses, one.impulses);
  }
  return all;
}

GroundContact::Action GroundContact::act_on(Soil& soil, std::size_t i) {
  constexpr int surfaces = 4;        // a particle in a corner touches several
  constexpr double rounding = 1e-9;  // of positions that were put back to the reach [dx]
  Action action;
  const auto id = static_cast<std::size_t>(soil.id[i]);
  const Vec2 start = soil.position(i), velocity = soil.velocity(i);
  for (int k = 0; k < surfaces; ++k) {
    const Vec2 x = soil.position(i);
    const Ground::Nearest near = ground_.nearest(x);
    const double gap = near.distance - reach * dx_;
    if (near.past_end || gap > -rounding * dx_) {
      constexpr double rounded_down = 1.0 - 1e-6;
      next_[id] = static_cast<float>(rounded_down * (travelled_ + std::max(gap, 0.0)));
      break;
    }
    if (near.distance < -deepest * dx_) {
      lost_[id] = 1;
      break;
    }
    // In a corner too narrow for the reach the line itself is as far as the particle can be put back.
    const double to = k + 1 < surfaces ? reach * dx_ : 0.0;
    const Vec2 normal = near.normal;
    const Vec2 back = near.point + to * normal;
    soil.x[i] = back.x;
    soil.y[i] = back.y;
    const Vec2 before = soil.velocity(i);
    slow_down(soil, i, normal,
              friction_[boundaries_.empty() ? near.line : friction_index(boundaries_, near.line, back.x)]);
    add_impulse(action, near.line, soil.m[i] * (before - soil.velocity(i)), near.point);
  }
  const Vec2 moved = soil.position(i) - start;
  action.put_back = norm(moved);
  action.taken = soil.m[i] * (0.5 * (norm2(velocity) - norm2(soil.velocity(i))) + dot(g_, moved));
  return action;
}

void GroundContact::add_impulse(Action& action, std::uint32_t line, Vec2 impulse, Vec2 at) const {
  for (std::size_t s = 0; s < loaded_.size(); ++s) {
    if (loaded_[s].boundary != static_cast<std::int32_t>(line)) continue;
    action.impulses.resize(loaded_.size());
    action.impulses[s] += {impulse, cross(at - loaded_[s].about, impulse)};
  }
}

void GroundContact::slow_down(Soil& soil, std::size_t i, Vec2 normal, const WallFriction& wall) const {
  const Vec2 v = soil.velocity(i);
  const double approach = -dot(v, normal);
  if (approach <= 0.0) return;
  const Vec2 along = v + approach * normal;
  const double speed = norm(along);
  const double tan_phi = wall.slip == WallSlip::free_slip ? 0.0 : std::min(soil.tan_phi[i], wall.tan_phi);
  const double kept = speed > 0.0 ? std::max(0.0, 1.0 - tan_phi * approach / speed) : 0.0;
  soil.vx[i] = kept * along.x;
  soil.vy[i] = kept * along.y;
}

std::int64_t GroundContact::lost() const { return std::accumulate(lost_.begin(), lost_.end(), std::int64_t{0}); }

void GroundContact::restore(std::vector<std::uint8_t> lost, double taken) {
  lost_ = std::move(lost);
  std::ranges::fill(next_, 0.0f);
  taken_ = taken;
}

}  // namespace talus
