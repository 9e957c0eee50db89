#pragma once
// The back end of production: packed particles, Verlet lists, vectors of single precision. The state and its sums over
// time stay in double precision. PlainFlow is its oracle.

#include "integrate/flow.hpp"
#include "integrate/schemes.hpp"
#include "sph/pair_loops.hpp"

namespace talus {

/// Keeps its rates packed; the soil's own arrays of rates and derived values are never used.
class VectorisedFlow final : public Flow {
 public:
  /// Starts with no rates and with the pressure of the soil's density.
  VectorisedFlow(FlowConstants constants, const Soil& soil);

  /// Whether a run with these options takes this back end: all do but those that ask for double precision.
  static bool serves(const Numerics& n) { return n.precision == Precision::single; }

  const char* name() const override { return "vectorised"; }
  const char* simd() const override { return pair_loops_target(); }
  /// One parallel region a step. Does not need the cells: it has lists.
  StepExtrema step(Soil& soil, WallParticles& walls, const ParticleCells& cells, double dt,
                   Powers* powers = nullptr) override;

  double resort_distance() const override { return 0.3; }
  void rebuild_neighbour_lists(const Soil& soil, const WallParticles& walls, const ParticleCells& cells,
                               double moved_since_sort, double skin) override;

  void permute_rates(Soil& soil, std::span<const std::uint32_t> order, std::vector<double>& scratch) override;
  void swap_rates(Soil& soil, std::size_t i, std::size_t j) override;
  void read_evaluation(const Soil& soil, Soil& to) const override;
  void write_evaluation(Soil& soil, const Soil& from) override;
  ElasticRates elastic_rates(const Soil& soil, std::size_t i) const override;
  void strength_changed(const Soil& soil) override { pack_strength(flow_, soil); }
  void drag_changed(const WallParticles& walls) override { pack_wall_cohesion(flow_, constants(), walls); }

  /// The operation of integrate/schemes.hpp, outside a step: rates of the soil, and stress of the walls, at the state
  /// that the present rates lead to after `ahead` [s].
  void evaluate(Soil& soil, WallParticles& walls, double ahead, bool commit);

  /// To be called when something else than step() has changed the state of the soil.
  void state_changed() override { present_is_packed_ = false; }

 private:
  /// The soil's clusters [begin, end) of one thread, and the next ones to be taken in each pass. A cache line to
  /// itself.
  struct alignas(64) ThreadRange {
    std::size_t begin, end, stress, momentum;
  };
  struct ThreadStep;

  void pack_active(const Soil& soil, double ahead);
  void partition_work();
  template <class F>
  void for_clusters_with_stealing(std::size_t ThreadRange::*next, std::size_t ThreadRange::*other, F&& f);
  template <class F>
  void for_local_particles(std::size_t active, F&& f);
  void evaluate_in_region(Soil& soil, WallParticles& walls, double ahead, bool commit, bool pack, bool measure,
                          Stopwatch& watch);

  void sum_loads_in_region();

  PackedFlow flow_;
  std::vector<WallLoad> load_of_cluster_;  ///< of the last step, cluster by cluster for each boundary
  std::vector<std::size_t> work_ = {0};    ///< neighbours to sum over in all batches before each one
  std::vector<ThreadRange> ranges_;        ///< by thread
  bool present_is_packed_ = false;         ///< the packed arrays hold the present state
};

}  // namespace talus
