#pragma once
// The part of the bed's resistance that grows with the speed of the flow.

#include <vector>

#include "particles/particles.hpp"
#include "simulation/model.hpp"
#include "sph/flow_constants.hpp"

namespace talus {

/// Voellmy's turbulent friction, rho g v^2/xi (Voellmy 1955, Schweizerische Bauzeitung 73; Salm 1993, Annals of
/// Glaciology 18), v the mean velocity of the soil in a vertical column. [Pa]
/// @param density  of the column [kg/m3]
/// @param g        [m/s2]
/// @param speed    v [m/s]
/// @param xi       turbulence coefficient [m/s2], > 0
inline double turbulent_friction(double density, double g, double speed, double xi) {
  return density * g * speed * speed / xi;
}

/// Keeps WallParticles::drag of the walls with a turbulence coefficient; without any it does nothing. Not thread-safe;
/// runs on one thread.
class BasalDrag {
 public:
  /// @param walls  in their final order
  BasalDrag(const FlowConstants& k, WallParticles& walls);

  bool active() const { return !xi_.empty(); }
  /// Of the velocities that the soil has now. A pure function of soil and walls.
  void act(const Soil& soil, WallParticles& walls) const;

 private:
  /// Soil of a column.
  struct Column {
    double mass = 0.0, volume = 0.0;  ///< [kg/m], at the reference density [m2]
    Vec2 momentum;                    ///< [kg/s]
  };
  std::size_t column(double x) const;

  double g_ = 0.0, width_ = 1.0;  ///< [m/s2], of a column [m]
  double left_ = 0.0;             ///< where the first column begins [m]
  std::size_t columns_ = 0;
  std::vector<double> rho0_;       ///< by material [kg/m3]
  std::vector<double> xi_;         ///< of each wall particle [m/s2]; 0: none
  std::vector<std::size_t> over_;  ///< column over each wall particle's foot
};

}  // namespace talus
