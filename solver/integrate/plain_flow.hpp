#pragma once
// The back end of double precision, one pair after the other: the oracle of VectorisedFlow.

#include "integrate/flow.hpp"
#include "integrate/plain_state.hpp"

namespace talus {

/// Keeps its rates in the arrays of the soil.
class PlainFlow final : public Flow {
 public:
  /// Starts with no rates and with the pressure of the soil's density.
  PlainFlow(FlowConstants constants, Soil& soil);

  const char* name() const override { return "plain"; }
  const char* simd() const override { return "none"; }
  StepExtrema step(Soil& soil, WallParticles& walls, const ParticleCells& cells, double dt) override;

  /// Every search pays for the distance, since there are no lists.
  double resort_distance() const override { return 0.1; }
  void rebuild_neighbour_lists(const Soil&, const WallParticles&, const ParticleCells&, double, double) override {}

  void permute_rates(Soil& soil, std::span<const std::uint32_t> order, std::vector<double>& scratch) override;
  void swap_rates(Soil& soil, std::size_t i, std::size_t j) override;
  void read_evaluation(const Soil& soil, Soil& to) const override;
  void write_evaluation(Soil& soil, const Soil& from) override;

 private:
  StepStart start_;
};

}  // namespace talus
