#pragma once
// The back end of double precision, one pair after the other: the oracle of VectorisedFlow.

#include <functional>

#include "integrate/flow.hpp"
#include "integrate/schemes.hpp"

namespace talus {

/// Evaluates the rates of the soil at its present state: writes ax, ay, drho, dt**; may change t** (return to yield).
using Evaluate = std::function<void(Soil&)>;

/// Lets the schemes of integrate/schemes.hpp move `soil`. Refers to its arguments, which must live longer.
class PlainState {
 public:
  /// @param start  keeps the state at the start of a step while the soil's arrays hold the middle; its memory is reused
  PlainState(Soil& soil, Soil& start, const Evaluate& evaluate) : soil_(soil), start_(start), evaluate_(evaluate) {}

  void evaluate(double ahead, bool commit);
  void move(double dt, PositionVelocity velocity);

 private:
  Soil& soil_;
  Soil& start_;
  const Evaluate& evaluate_;
};

/// Keeps its rates in the arrays of the soil.
class PlainFlow final : public Flow {
 public:
  /// Starts with no rates and with the pressure of the soil's density.
  PlainFlow(FlowConstants constants, Soil& soil);

  const char* name() const override { return "plain"; }
  const char* simd() const override { return "none"; }
  StepExtrema step(Soil& soil, WallParticles& walls, const ParticleCells& cells, double dt,
                   Powers* powers = nullptr) override;

  /// Every search pays for the distance, since there are no lists.
  double resort_distance() const override { return 0.1; }
  void rebuild_neighbour_lists(const Soil&, const WallParticles&, const ParticleCells&, double, double) override {}

  void permute_rates(Soil& soil, std::span<const std::uint32_t> order, std::vector<double>& scratch) override;
  void swap_rates(Soil& soil, std::size_t i, std::size_t j) override;
  void read_evaluation(const Soil& soil, Soil& to) const override;
  void write_evaluation(Soil& soil, const Soil& from) override;
  ElasticRates elastic_rates(const Soil& soil, std::size_t i) const override {
    return {soil.drho[i], soil.dtxx[i], soil.dtyy[i], soil.dtxy[i]};
  }

 private:
  Soil start_;
  ParticlePowers<double> powers_;
};

}  // namespace talus
