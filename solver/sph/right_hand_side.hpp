#pragma once
// The right-hand side of the landslide: neighbours -> velocity gradient -> stress -> walls -> acceleration.

#include <vector>

#include "neighbours/cell_list.hpp"
#include "particles/particles.hpp"
#include "sph/flow_constants.hpp"
#include "sph/kernel.hpp"

namespace talus {

/// Evaluates rates of change in double precision, one pair after the other: the oracle of VectorisedFlow. Gather loops
/// only: every particle sums its own neighbours in the order of the cells, so the result has the same bits for any
/// number of threads.
class RightHandSide {
 public:
  explicit RightHandSide(FlowConstants constants);

  /// Fills ax, ay, drho, dt** and the derived p, s**, gamma_dot of the active soil, and the extrapolated stress of the
  /// walls. With the elastic law it first returns t** to the yield surface. The reach of both cell lists must cover 2h
  /// around every particle's present position.
  void evaluate(Soil& soil, WallParticles& walls, const CellList& soil_cells, const CellList& wall_cells);

  /// One pass of the Shepard filter over the densities of the active soil.
  void filter_density(Soil& soil, const WallParticles& walls, const CellList& soil_cells,
                      const CellList& wall_cells) const;

  const FlowConstants& constants() const { return k_; }

 private:
  /// What the first pass knows of a particle before its law.
  struct Rates {
    Mat2 L;
    double drho, wall_distance;
  };

  template <class Kernel>
  void evaluate_plain(const Kernel& kernel, Soil& soil, WallParticles& walls, const CellList& soil_cells,
                      const CellList& wall_cells) const;
  template <class Kernel>
  Rates soil_rates(const Kernel& kernel, const Soil& soil, std::size_t i, const CellList& soil_cells) const;
  template <class Kernel>
  void add_wall_rates(const Kernel& kernel, const Soil& soil, std::size_t i, const WallParticles& walls,
                      const CellList& wall_cells, Rates& rates) const;
  template <class Kernel>
  void wall_stress(const Kernel& kernel, const Soil& soil, WallParticles& walls, std::size_t w,
                   const CellList& soil_cells) const;
  template <class Kernel>
  Vec2 soil_acceleration(const Kernel& kernel, const Soil& soil, std::size_t i, const CellList& soil_cells) const;
  template <class Kernel>
  Vec2 wall_acceleration(const Kernel& kernel, const Soil& soil, std::size_t i, const WallParticles& walls,
                         const CellList& wall_cells) const;
  template <class Kernel>
  void shepard(const Kernel& kernel, Soil& soil, const WallParticles& walls, const CellList& soil_cells,
               const CellList& wall_cells) const;
  void apply_law(Soil& soil, std::size_t i, const Rates& rates) const;

  FlowConstants k_;
  double tan_phi_wall_;
  std::vector<double> rho0_;  ///< by material [kg/m3]
};

}  // namespace talus
