#pragma once
// Contact of single particles with the ground. Soil at its full density is held by the pressure of the walls; soil that
// has come apart has no pressure, and nothing else would hold it.

#include <cstdint>
#include <span>
#include <vector>

#include "particles/ground.hpp"
#include "particles/particles.hpp"
#include "sph/flow_constants.hpp"
#include "sph/wall_load.hpp"

namespace talus {

/// An inelastic contact with Coulomb friction. It takes energy from the soil and never gives any: a particle is put
/// back to where the ground begins, loses the velocity with which it came, and is slowed along the ground by
/// tan(phi) times the velocity lost, by the smaller of the soil's and the boundary's friction, without friction where
/// the boundary has free slip.
/// Not thread-safe; the loops inside run on OpenMP's threads, with the same bits for any number of them.
class GroundContact {
 public:
  /// Nearer to the ground than this the contact acts [dx]. Soil that bears load keeps about half a spacing.
  static constexpr double reach = 0.1;
  /// Soil deeper in the ground than this after a step has not come through the surface in it: it is not put back, and
  /// counts as lost in the ground [dx].
  static constexpr double deepest = 0.5;

  /// @param lines     of the boundaries, at least one
  /// @param friction  as wall_friction() returns it
  /// @param boundaries  whose stretches have frictions of their own; empty: none has
  /// @param dx        particle spacing [m]
  /// @param g         gravity [m/s2]
  GroundContact(std::vector<Polyline> lines, std::vector<WallFriction> friction, double dx, Vec2 g,
                std::size_t particles, std::vector<Boundary> boundaries = {});

  /// To be called after every step.
  /// @param displacement  of the particle that moved the farthest since the last call [m]
  /// @return the largest distance that a particle was put back [m]; 0 where the contact has not acted
  double act(Soil& soil, double displacement);

  /// From now on the impulses on these boundaries are summed up.
  void observe_loads(std::vector<LoadedBoundary> boundaries) { loaded_ = std::move(boundaries); }
  /// Impulse of the last call of act() on each of them: what the soil's momentum lost [N s/m]. Zeros, or nothing where
  /// it has not acted.
  const std::vector<WallLoad>& impulses() const { return impulses_; }

  /// Particles that have ever been lost in the ground.
  std::int64_t lost() const;
  /// By id: 1 for those; for checkpoints.
  const std::vector<std::uint8_t>& lost_ids() const { return lost_; }
  /// Kinetic and potential energy that the contact has taken so far [J/m].
  double taken() const { return taken_; }
  void restore(std::vector<std::uint8_t> lost, double taken);

 private:
  /// What was done to one particle or to several.
  struct Action {
    double put_back = 0.0;                ///< largest distance [m]
    double taken = 0.0;                   ///< kinetic and potential energy [J/m]
    std::vector<WallLoad> impulses = {};  ///< on the boundaries that are observed; empty: none
  };
  Action act_on_some(Soil& soil, std::size_t begin, std::size_t end);
  Action act_on(Soil& soil, std::size_t i);
  void add_impulse(Action& action, std::uint32_t line, Vec2 impulse, Vec2 at) const;
  void slow_down(Soil& soil, std::size_t i, Vec2 normal, const WallFriction& wall) const;

  Ground ground_;
  std::vector<WallFriction> friction_;
  std::vector<Boundary> boundaries_;
  double dx_;
  Vec2 g_;
  double travelled_ = 0.0;   ///< sum of the displacements so far [m]
  std::vector<float> next_;  ///< by id: value of travelled_ before which the particle cannot be in reach [m]
  std::vector<std::uint8_t> lost_;
  std::vector<Action> actions_;  ///< of the last call, by group of particles
  double taken_ = 0.0;
  std::vector<LoadedBoundary> loaded_;
  std::vector<WallLoad> impulses_;  ///< of the last call
};

}  // namespace talus
