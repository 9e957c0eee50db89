#pragma once
// The particles as a structure of arrays: soil that moves and is kept sorted by cell, walls that stand still.

#include <cstdint>
#include <vector>

#include "math/tensor.hpp"
#include "math/vec2.hpp"

namespace talus {

/// Soil particles; every array has size() entries, or none where its comment says so, and all are permuted together.
/// The first n_active take part in the flow; the rest left through an open end and keep their last state.
struct Soil {
  std::vector<double> x, y;           ///< position [m]
  std::vector<double> vx, vy;         ///< velocity [m/s]
  std::vector<double> rho;            ///< density [kg/m3]
  std::vector<double> txx, tyy, txy;  ///< deviatoric stress of the elastic law [Pa]
  std::vector<double> m;              ///< mass [kg/m]
  std::vector<double> tan_phi;        ///< tangent of the friction angle [-]
  std::vector<double> c;              ///< cohesion [Pa]
  std::vector<double> rho0;           ///< reference density [kg/m3]; empty: that of each material
  std::vector<double> eta;            ///< viscosity once it has yielded [Pa s]; empty: that of each material
  // What evaluations in double precision write; empty where the vectorised loops run, which keep their own.
  std::vector<double> ax, ay;             ///< acceleration of the last evaluation [m/s2]
  std::vector<double> drho;               ///< rate of density [kg/m3/s]
  std::vector<double> dtxx, dtyy, dtxy;   ///< rate of deviatoric stress [Pa/s]
  std::vector<double> gamma_dot;          ///< shear rate of the last evaluation [1/s]
  std::vector<double> p;                  ///< pressure of the last evaluation [Pa]
  std::vector<double> sxx, syy, sxy;      ///< Cauchy stress of the last evaluation [Pa]
  std::vector<float> x_sorted, y_sorted;  ///< position at the last sort, rounded [m]
  std::vector<std::int32_t> material;
  std::vector<std::int32_t> id;  ///< identity, 0..size()-1
  std::size_t n_active = 0;

  std::size_t size() const { return x.size(); }
  Vec2 position(std::size_t i) const { return {x[i], y[i]}; }
  Vec2 velocity(std::size_t i) const { return {vx[i], vy[i]}; }
  Sym2 stress(std::size_t i) const { return {sxx[i], syy[i], sxy[i]}; }
};

/// The one list of the soil's arrays of doubles, in three parts; each function calls f(name, array).
/// State: what a particle is.
template <class S, class F>
void for_each_state(S& s, F&& f) {
  f("x", s.x);
  f("y", s.y);
  f("vx", s.vx);
  f("vy", s.vy);
  f("rho", s.rho);
  f("txx", s.txx);
  f("tyy", s.tyy);
  f("txy", s.txy);
  f("m", s.m);
  f("tan_phi", s.tan_phi);
  f("c", s.c);
  if (!s.rho0.empty()) f("rho0", s.rho0);
  if (!s.eta.empty()) f("eta", s.eta);
}
/// Rates of the last evaluation: the leapfrog predicts with them.
template <class S, class F>
void for_each_rate(S& s, F&& f) {
  f("ax", s.ax);
  f("ay", s.ay);
  f("drho", s.drho);
  f("dtxx", s.dtxx);
  f("dtyy", s.dtyy);
  f("dtxy", s.dtxy);
}
/// What an evaluation derives for pictures and walls.
template <class S, class F>
void for_each_derived(S& s, F&& f) {
  f("gamma_dot", s.gamma_dot);
  f("p", s.p);
  f("sxx", s.sxx);
  f("syy", s.syy);
  f("sxy", s.sxy);
}
/// Wall particles; fixed, sorted by cell once.
struct WallParticles {
  std::vector<double> x, y;            ///< position [m]
  std::vector<double> nx, ny;          ///< unit normal of the wall, towards the soil
  std::vector<double> depth;           ///< distance to the wall line [m]
  std::vector<double> p;               ///< pressure extrapolated from the soil [Pa]
  std::vector<double> sxx, syy, sxy;   ///< stress extrapolated from the soil [Pa]
  std::vector<double> density_ratio;   ///< rho/rho0 of the soil extrapolated to here [-]; 0 where no soil is near
  std::vector<double> drag;            ///< turbulent friction, rho g v^2/xi [Pa]; empty where no wall has any
  std::vector<std::int32_t> boundary;  ///< index of the friction of each in FlowConstants::boundaries
  double volume = 0.0;                 ///< of each particle [m3/m]

  std::size_t size() const { return x.size(); }
  Vec2 position(std::size_t j) const { return {x[j], y[j]}; }
  Vec2 normal(std::size_t j) const { return {nx[j], ny[j]}; }
  Sym2 stress(std::size_t j) const { return {sxx[j], syy[j], sxy[j]}; }
};

/// The arrays of the walls that evaluations write.
template <class W, class F>
void for_each_wall_real(W& w, F&& f) {
  f("wall_p", w.p);
  f("wall_sxx", w.sxx);
  f("wall_syy", w.syy);
  f("wall_sxy", w.sxy);
  f("wall_density_ratio", w.density_ratio);
}

}  // namespace talus
