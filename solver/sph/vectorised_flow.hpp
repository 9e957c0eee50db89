#pragma once
// The right-hand side at speed: packed particles, lists of neighbours that last some steps, vectors of single
// precision. State and its summation over time stay in double. RightHandSide is its oracle.

#include <cstdint>
#include <span>

#include "math/stopwatch.hpp"
#include "neighbours/cell_list.hpp"
#include "sph/pair_loops.hpp"

namespace talus {

class VectorisedFlow {
 public:
  /// Starts with no rates and with the pressure of the soil's density. The soil's own arrays of rates and derived
  /// values are never used.
  VectorisedFlow(FlowConstants constants, const Soil& soil);

  /// Whether a run with these options takes these loops: all do but those that ask for double precision.
  static bool serves(const Numerics& n) { return n.precision == Precision::single; }

  /// Finds the neighbours anew. Call it when the soil has been sorted, and again before a particle goes further than
  /// `way` [m] from where it is now. No particle has moved further than `moved` [m] since soil_cells was built.
  void renew(const Soil& soil, const WallParticles& walls, const CellList& soil_cells, const CellList& wall_cells,
             double moved, double way);

  /// Rates of the soil, and the extrapolated stress of the walls, at the state that the present rates lead to after
  /// `ahead` [s]; the state itself stays. The elastic stress is returned to the yield surface there; `keep`: in the
  /// state as well.
  void evaluate(Soil& soil, WallParticles& walls, double ahead, bool keep);

  /// Time spent in the passes so far.
  const StageTimes& times() const { return times_; }

  /// Moves the state on by dt [s]: midpoint Runge-Kutta (`rk2`: evaluates here and ahead, moves with the velocities of
  /// the middle), or leapfrog (evaluates ahead, moves with the mean of the old and the new velocities). One parallel
  /// region.
  Motion step(Soil& soil, WallParticles& walls, double dt, bool rk2);

  /// Tells that something else than step() has changed the state since.
  void state_changed() { packed_now_ = false; }

  /// Writes rates, p, s**, gamma_dot of the last evaluation into the arrays of `soil`, and takes them over from there.
  void unpack(Soil& soil) const;
  void pack(const Soil& soil);

  /// Follows the soil when two particles change places, and when all are sorted.
  void swap(std::size_t i, std::size_t j);
  void permute(std::span<const std::uint32_t> order, std::vector<double>& scratch);

 private:
  void pack_active(const Soil& soil, double ahead);
  /// The soil's clusters up to `end` for one thread; the next ones to be taken in each pass. A line of the cache to
  /// itself.
  struct alignas(64) Share {
    std::size_t begin, end, stress, momentum;
  };
  void share_out();
  template <class F>
  void for_clusters(std::size_t Share::*next, std::size_t Share::*other, F&& f);
  template <class F>
  void for_own(std::size_t active, F&& f);
  void evaluate_here(Soil& soil, WallParticles& walls, double ahead, bool keep, bool pack, Stopwatch& watch);

  FlowConstants k_;
  PackedFlow flow_;
  std::vector<std::size_t> work_ = {0};  ///< of all chunks before each one
  std::vector<Share> shares_;
  bool packed_now_ = false;  ///< the present state is packed
  StageTimes times_;
};

}  // namespace talus
