#include "sph/right_hand_side.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "sph/continuity-inl.hpp"
#include "sph/energy-inl.hpp"
#include "sph/kernel-inl.hpp"
#include "sph/momentum-inl.hpp"
#include "sph/wall-inl.hpp"

namespace talus {
namespace {

using namespace HWY_NAMESPACE;  // the laws, here for double

constexpr std::size_t grain = 128;  ///< particles that a thread takes at a time

Vector<double> vector(Vec2 a) { return {a.x, a.y}; }

/// Calls interact(j, r_ij, r2) for every j of `cells` within the support of x_i, itself included, in the order of the
/// cells.
template <class Points, class Interaction>
void for_neighbours(const CellList& cells, const Points& points, Vec2 x_i, double support2, Interaction&& interact) {
  cells.for_ranges(x_i, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) {
      const Vector<double> r{x_i.x - points.x[j], x_i.y - points.y[j]};
      const double r2 = dot(r, r);
      if (r2 < support2) interact(j, r, r2);
    }
  });
}

/// One particle of the soil, as update_point reads and writes it.
struct SoilPoint {
  const FlowConstants& k;
  Soil& soil;
  ParticlePowers<double>* powers;
  std::size_t i;
  Symmetric<double>* strain = nullptr;  ///< the strain rate goes there

  const ConstitutiveParameters& parameters(std::size_t j) const {
    return k.soils[static_cast<std::size_t>(soil.material[j])];
  }
  double reference_density() const { return talus::reference_density(k, soil, i); }
  double viscosity() const { return stated_viscosity(k, soil, i); }
  double q() const { return soil.rho[i] / reference_density() - 1.0; }
  double c() const { return soil.c[i]; }
  double density() const { return pair_density(soil.rho[i], least_density(reference_density())); }
  double volume() const { return soil.m[i] / density(); }
  template <class Get>
  double constant(Get&& get) const {
    return get(parameters(i));
  }
  const SoilPoint& elastic() const { return *this; }
  void set_strain_rate(Symmetric<double> e) const { *strain = e; }
  void set_stress(Symmetric<double> s, double p) const {
    soil.sxx[i] = s.xx;
    soil.syy[i] = s.yy;
    soil.sxy[i] = s.xy;
    soil.p[i] = p;
  }
  void set_rates(double drho, double gamma_dot) const {
    soil.drho[i] = drho;
    soil.gamma_dot[i] = gamma_dot;
  }
  template <class Of>
  void set_powers(Of&& of) const {
    if (!powers) return;
    const StressPowers<double> values = of(volume());
    powers->deviator[i] = values.deviator;
    powers->viscosity[i] = values.viscosity;
    powers->density_diffusion[i] = values.density_diffusion;
  }

  Deviator<double> value() const { return {soil.txx[i], soil.tyy[i], soil.txy[i]}; }
  void add(Deviator<double> change) const {
    soil.txx[i] += change.xx;
    soil.tyy[i] += change.yy;
    soil.txy[i] += change.xy;
  }
  void set_rate(Deviator<double> rate) const {
    soil.dtxx[i] = rate.xx;
    soil.dtyy[i] = rate.yy;
    soil.dtxy[i] = rate.xy;
  }
};

/// The passes over all particles, for one kernel.
template <class Kernel>
struct Passes {
  const FlowConstants& k;
  Soil& soil;
  WallParticles& walls;
  const ParticleCells& cells;
  ParticlePowers<double>* powers;
  Kernel kernel{1.0 / k.h};
  double sigma = sigma_h2<Kernel>(k.h), support2 = 4.0 * k.h * k.h;
  WallLaw<double> wall_law{k, 1.0};
  std::vector<Symmetric<double>> strain{};  ///< rates, of all particles [1/s]

  double minus_F(double r2) const { return kernel.minus_F(std::sqrt(r2), r2); }
  Symmetric<double> stress(std::size_t i) const { return {soil.sxx[i], soil.syy[i], soil.sxy[i]}; }
  Symmetric<double> wall_stress(std::size_t j) const { return {walls.sxx[j], walls.syy[j], walls.sxy[j]}; }
  const WallFriction& boundary(std::size_t j) const {
    return k.boundaries[static_cast<std::size_t>(walls.boundary[j])];
  }
  WallParticle<double> wall_particle(std::size_t j) const {
    return {vector(walls.normal(j)), walls.depth[j], boundary(j).slip == WallSlip::free_slip};
  }
  double q(std::size_t j) const { return SoilPoint{k, soil, nullptr, j}.q(); }
  double density(std::size_t j) const { return SoilPoint{k, soil, nullptr, j}.density(); }
  double volume(std::size_t j) const { return SoilPoint{k, soil, nullptr, j}.volume(); }

  template <class Model>
  void update_stress(std::size_t i) {
    const double c2 = k.c_s * k.c_s, rho_i = density(i);
    const bool by_mass = k.numerics.continuity == Continuity::mass,
               diffuse = k.numerics.density_filter == DensityFilter::delta_sph;
    const Vector<double> v_i = vector(soil.velocity(i)), g_per_c2{k.g.x / c2, k.g.y / c2};
    const auto dynamic = [&](std::size_t j) { return dynamic_density(q(j), g_per_c2, vector(soil.position(j))); };
    const double dynamic_i = dynamic(i);
    auto sums = FlowRateSums<double>::zero();
    MohrCoulomb<double> strength{soil.c[i], soil.tan_phi[i]};
    const double p_i = wall_law.turbulent ? pressure_of(k, SoilPoint{k, soil, nullptr, i}) : 0.0;
    for_neighbours(cells.soil, soil, soil.position(i), support2, [&](std::size_t j, Vector<double> r, double r2) {
      const double VF = volume(j) * minus_F(r2);
      sums.add(VF, density(j), v_i - vector(soil.velocity(j)), r, by_mass);
      if (diffuse && soil.material[j] == soil.material[i])
        sums.diffusion = add_diffusion(sums.diffusion, VF, dynamic(j) - dynamic_i);
    });
    for_neighbours(cells.walls, walls, soil.position(i), support2, [&](std::size_t j, Vector<double> r, double r2) {
      const WallPair<double> w = wall_law.pair(r, v_i, wall_particle(j));
      if (wall_law.only_approaching && w.v_dot_r >= 0.0) return;
      sums.add(walls.volume * minus_F(r2), rho_i, w.v_ij, r, by_mass);
      const MohrCoulomb<double> of_wall{wall_cohesion(k, walls, j), boundary(j).tan_phi};
      strength = wall_law.strength(strength, of_wall, p_i, w.distance < wall_law.thickness);
    });
    const double to_diffusion = 2.0 * k.numerics.delta * k.h * k.c_s * sigma;
    update_point(k, Model(k.rheology), sums.rates(-sigma, to_diffusion, by_mass, rho_i), strength,
                 SoilPoint{k, soil, powers, i, &strain[i]});
  }

  void update_wall_stress(std::size_t w) const {
    auto sum = WallStressSum<double>::zero();
    for_neighbours(cells.soil, soil, walls.position(w), support2, [&](std::size_t j, Vector<double> r, double r2) {
      sum.add(kernel.W(std::sqrt(r2)), {stress(j), soil.p[j], density(j), q(j), soil.c[j], soil.tan_phi[j]},
              dot(vector(k.g), r), 1.0 / (k.c_s * k.c_s));
    });
    const WallFriction& friction = boundary(w);
    const WallStress<double> wall =
        sum.value(k, vector(walls.normal(w)), {wall_cohesion(k, walls, w), friction.tan_phi},
                  friction.slip == WallSlip::free_slip);
    walls.p[w] = wall.p;
    walls.density_ratio[w] = wall.density_ratio;
    walls.sxx[w] = wall.s.xx;
    walls.syy[w] = wall.s.yy;
    walls.sxy[w] = wall.s.xy;
  }

  template <bool Quadratic, bool Reconstruct>
  void update_acceleration(std::size_t i) const {
    const ArtificialViscosity<double, Quadratic> viscosity(k, 1.0);
    const ReconstructedViscosity<double, Quadratic> reconstructed(k, 1.0);
    const Vector<double> v_i = vector(soil.velocity(i));
    const double rho_i = density(i), viscosity_of_i = viscosity.of_particle(rho_i);
    const Symmetric<double> s_i = stress(i), e_i = strain[i];
    const WallForce<double, Quadratic, Reconstruct> wall(k, 1.0);
    Vector<double> sum{0.0, 0.0};
    auto pair_powers = PairPowers<double>::zero();
    for_neighbours(cells.soil, soil, soil.position(i), support2, [&](std::size_t j, Vector<double> r, double r2) {
      const double v_dot_r = dot(v_i - vector(soil.velocity(j)), r);
      const double twice_smooth = dot((e_i + strain[j]) * r, r) / k.h;
      const double Pi = Reconstruct
                            ? reconstructed(reconstructed.of_particle(rho_i), density(j), v_dot_r, twice_smooth, r2)
                            : viscosity(viscosity_of_i, rho_i, density(j), std::min(v_dot_r, 0.0), r2);
      const double VF = volume(j) * minus_F(r2);
      sum = add_force(sum, s_i, stress(j), Pi, VF, r);
      if (powers) pair_powers.add_soil(Pi, VF, v_dot_r);
    });
    for_neighbours(cells.walls, walls, soil.position(i), support2, [&](std::size_t j, Vector<double> r, double r2) {
      const WallTerm<double> term = wall.term(viscosity_of_i, rho_i, v_i, wall_particle(j), minus_F(r2), r, r2);
      const Symmetric<double> s_w = wall_stress(j);
      sum = wall.add(sum, s_i, s_w, term, r);
      if (powers) pair_powers.add_wall(s_i, s_w, term.Pi, term.VF, v_i, term.v_ij, r, term.arm);
    });
    const Vector<double> a = fma(-sigma / rho_i, sum, vector(k.g));
    soil.ax[i] = a.x;
    soil.ay[i] = a.y;
    if (!powers) return;
    const double V_to_F = -sigma * volume(i);
    powers->artificial_viscosity[i] = pair_powers.taken_by_viscosity(V_to_F);
    powers->boundaries[i] = pair_powers.taken_by_boundaries(V_to_F);
  }

  template <bool Quadratic, bool Reconstruct>
  WallLoad load_on(const LoadedBoundary& loaded) const {
    const WallForce<double, Quadratic, Reconstruct> force(k, 1.0);
    WallLoad load;
    for (std::size_t i = 0; i < soil.n_active; ++i) {
      const Vec2 x = soil.position(i);
      for_neighbours(cells.walls, walls, x, support2, [&](std::size_t j, Vector<double> r, double r2) {
        if (walls.boundary[j] != loaded.boundary) return;
        const WallTerm<double> term = force.term(force.viscosity.of_particle(density(i)), density(i),
                                                 vector(soil.velocity(i)), wall_particle(j), minus_F(r2), r, r2);
        const Vector<double> one = force.add({0.0, 0.0}, stress(i), wall_stress(j), term, r);
        const Vec2 on_wall = (sigma * volume(i)) * Vec2{one.x, one.y};
        load.force += on_wall;
        load.moment += cross(x - 0.5 * Vec2{r.x, r.y} - loaded.about, on_wall);
      });
    }
    return load;
  }

  template <class Model>
  void evaluate() {
    strain.resize(soil.n_active);
#pragma omp parallel
    {
#pragma omp for schedule(static, grain)
      for (std::size_t i = 0; i < soil.n_active; ++i) update_stress<Model>(i);
#pragma omp for schedule(static, grain)
      for (std::size_t w = 0; w < walls.size(); ++w) update_wall_stress(w);
#pragma omp for schedule(static, grain)
      for (std::size_t i = 0; i < soil.n_active; ++i) {
        with_artificial_viscosity(
            k.numerics, [&]<bool Quadratic, bool Reconstruct>() { update_acceleration<Quadratic, Reconstruct>(i); });
      }
    }
  }
};

// "Regularized correction of density" ([Z20] 2.1) by the Shepard filter. It runs every few steps only, in double
// precision beside both kinds of loops, and on kernels with their normalisation: other products would round
// differently, and results are to stay the same bit for bit.

/// W [1/m2] of the kernels in kernel-inl.hpp, in double precision.
struct ShepardKernel {
  KernelShape shape;
  double inverse_h;  ///< [1/m]
  double sigma;      ///< normalisation [1/m2]

  /// @param h  smoothing length [m], > 0
  ShepardKernel(KernelShape kernel, double h)
      : shape(kernel),
        inverse_h(1.0 / h),
        sigma(kernel == KernelShape::wendland_c2 ? 7.0 / (4.0 * std::numbers::pi * h * h)
                                                 : 15.0 / (7.0 * std::numbers::pi * h * h)) {}

  /// @param r2  squared distance [m2]
  double W(double r2) const {
    const double u = std::sqrt(r2) * inverse_h;
    if (shape == KernelShape::wendland_c2) {
      const double w = 1.0 - 0.5 * u;
      return w > 0.0 ? sigma * w * w * w * w * (2.0 * u + 1.0) : 0.0;
    }
    if (u < 1.0) return sigma * (2.0 / 3.0 - u * u + 0.5 * u * u * u);
    const double w = 2.0 - u;
    return w > 0.0 ? sigma / 6.0 * w * w * w : 0.0;
  }
};

/// rho_i/rho0_i <- sum_j V_j q_j W_ij / sum_j V_j W_ij with q = rho/rho0, itself included.
/// For one material this is sum m_j W_ij / sum V_j W_ij.
struct ShepardSum {
  double weighted = 0.0, weight = 0.0;

  void add(double V_j, double q_j, double W) {
    weighted += V_j * q_j * W;
    weight += V_j * W;
  }
  double value() const { return weighted / weight; }
};

/// Shepard-filtered density of one particle [kg/m3].
double filtered_density(const FlowConstants& k, const Soil& soil, std::size_t i, const WallParticles& walls,
                        const ParticleCells& cells) {
  const double support2 = 4.0 * k.h * k.h;
  const ShepardKernel kernel(k.numerics.kernel, k.h);
  const auto rho0 = [&](std::size_t j) { return reference_density(k, soil, j); };
  ShepardSum sum;
  for_neighbours(cells.soil, soil, soil.position(i), support2, [&](std::size_t j, Vector<double>, double r2) {
    sum.add(soil.m[j] / soil.rho[j], soil.rho[j] / rho0(j), kernel.W(r2));
  });
  for_neighbours(cells.walls, walls, soil.position(i), support2, [&](std::size_t j, Vector<double>, double r2) {
    if (walls.density_ratio[j] > 0.0) sum.add(walls.volume, walls.density_ratio[j], kernel.W(r2));
  });
  return rho0(i) * sum.value();
}

}  // namespace

void evaluate_plain(const FlowConstants& k, Soil& soil, WallParticles& walls, const ParticleCells& cells,
                    ParticlePowers<double>* powers) {
  if (powers) powers->resize(soil.size());
  with_kernel<double>(k.numerics.kernel, [&]<class Kernel>(std::type_identity<Kernel>) {
    with_constitutive_model<double>(k.rheology, [&]<class Model>(std::type_identity<Model>) {
      Passes<Kernel>{k, soil, walls, cells, powers}.template evaluate<Model>();
    });
  });
}

WallLoad load_on(const FlowConstants& k, const Soil& soil, const WallParticles& walls, const ParticleCells& cells,
                 const LoadedBoundary& boundary) {
  WallLoad load;
  // The passes read soil and walls only here.
  auto& read_soil = const_cast<Soil&>(soil);
  auto& read_walls = const_cast<WallParticles&>(walls);
  with_kernel<double>(k.numerics.kernel, [&]<class Kernel>(std::type_identity<Kernel>) {
    const Passes<Kernel> passes{k, read_soil, read_walls, cells, nullptr};
    with_artificial_viscosity(k.numerics, [&]<bool Quadratic, bool Reconstruct>() {
      load = passes.template load_on<Quadratic, Reconstruct>(boundary);
    });
  });
  return load;
}

void filter_density(const FlowConstants& k, Soil& soil, const WallParticles& walls, const ParticleCells& cells) {
  std::vector<double> filtered(soil.n_active);
#pragma omp parallel for schedule(static, grain)
  for (std::size_t i = 0; i < soil.n_active; ++i) filtered[i] = filtered_density(k, soil, i, walls, cells);
  std::copy(filtered.begin(), filtered.end(), soil.rho.begin());
}

}  // namespace talus
