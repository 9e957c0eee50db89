// The keys of the strength of a material: friction and cohesion or undrained strength, pore pressure, softening; and
// the keys of water.

#include "case/sections.hpp"
#include "math/angle.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

constexpr Quantity strength_Pa{"Pa", 0.0, 1e9}, strength_kPa{"kPa", 0.0, 1e6};
constexpr double laboratory_gravity = 9.81;  ///< with which unit weights are stated [m/s2]
constexpr Names<PoreWater> motions[] = {{"carried", PoreWater::carried}};
constexpr const char* undrained_keys[] = {"undrained_strength_Pa", "undrained_strength_kPa"};
constexpr const char* cohesion_keys[] = {"cohesion_Pa", "cohesion_kPa"};

template <std::size_t N>
bool any_given(ObjectReader& in, const char* const (&keys)[N]) {
  bool given = false;
  for (const char* key : keys) given = in.find(key) != nullptr || given;
  return given;
}

/// What a layer inherits of the other kind of strength is dropped.
void become_undrained(MaterialInput& m) {
  if (m.undrained) return;
  m.undrained = true;
  m.phi = m.c = m.friction_angle_deg = 0.0;
  m.mu_i.reset();
  m.r_u.reset();
  m.softening.reset();
}
void become_drained(MaterialInput& m) {
  if (!m.undrained) return;
  m.undrained = false;
  m.c = m.c_gradient = m.gradient_kPa_per_m = 0.0;
  m.softening.reset();
}

void read_undrained_strength(ObjectReader& in, MaterialInput& m) {
  const bool drained_before = !m.undrained;
  std::optional<double> strength, gradient;
  in.optional_number_in_either(
      undrained_keys[0], strength, strength_Pa,
      {"Undrained shear strength c_u at the ground surface: the yield stress whatever the pressure, in total stress. "
       "Not together with friction angle, cohesion, r_u or mu_i.",
       "vane, cone or triaxial test", "none"},
      {undrained_keys[1], strength_kPa, 1000.0, {"The same in kPa.", "vane, cone or triaxial test", "none"}});
  in.optional_number("undrained_strength_gradient_kPa_per_m", gradient, {"kPa/m", 0.0, 1000.0},
                     {"Growth of c_u with the depth below the ground surface before the slide.",
                      "vane or cone profile; 1 to 2 kPa/m in soft clay", "0"});
  if (strength) m.c = *strength;
  if (gradient) m.gradient_kPa_per_m = *gradient;
  if (gradient && !strength && drained_before && !m.undrained)
    in.fault("undrained_strength_gradient_kPa_per_m",
             "needs undrained_strength_kPa, the strength at the ground surface");
  m.c_gradient = 1000.0 * m.gradient_kPa_per_m;
  if (!m.undrained) return;
  in.record(undrained_keys[0], m.c);
  if (m.gradient_kPa_per_m > 0.0) in.record("undrained_strength_gradient_kPa_per_m", m.gradient_kPa_per_m);
}

/// A residual value that is not above the peak, at which the key itself points, or that of the layer that inherits it.
void check_residual(ObjectReader& in, const char* residual_key, double residual, const char* key, double peak,
                    bool own) {
  if (residual <= peak) return;
  if (own)
    in.faults().add(pointer_to(in.pointer("softening"), residual_key),
                    to_text(residual) + " exceeds the peak value, " + key + " " + to_text(peak));
  else
    in.fault(key, to_text(peak) + " is less than " + residual_key + " of the default material's softening, " +
                      to_text(residual) + "; give this layer a softening of its own");
}

void read_residuals(ObjectReader& in, MaterialInput& m, Softening& s) {
  const bool undrained = m.undrained;
  std::optional<double> angle, cohesion, strength;
  in.optional_number("residual_friction_angle_deg", angle, friction_angle_range,
                     {"Residual friction angle, at most the peak one. A random field varies the peak; a particle whose "
                      "peak is lower keeps it.",
                      "ring shear test", "no loss of friction"});
  in.optional_number_in_either(
      "residual_cohesion_Pa", cohesion, strength_Pa,
      {"Residual cohesion.", "ring shear test; 0 in most soils", "no loss of cohesion"},
      {"residual_cohesion_kPa", strength_kPa, 1000.0, {"The same in kPa.", "ring shear test", "none"}});
  in.optional_number_in_either(
      "residual_undrained_strength_Pa", strength, strength_Pa,
      {"Residual undrained strength, the same at every depth; of undrained materials.",
       "vane test after several turns, or strength over sensitivity", "none, required if undrained"},
      {"residual_undrained_strength_kPa", strength_kPa, 1000.0, {"The same in kPa.", "vane test", "none"}});
  if (undrained && (angle || cohesion))
    in.fault(angle ? "residual_friction_angle_deg" : "residual_cohesion_Pa",
             "has no meaning for an undrained material; give residual_undrained_strength_kPa");
  if (!undrained && strength)
    in.fault("residual_undrained_strength_Pa",
             "has no meaning for a material with friction and cohesion; give residual_friction_angle_deg or "
             "residual_cohesion_kPa");
  if (!angle && !cohesion && !strength)
    in.fault("",
             "states no residual strength: residual_friction_angle_deg, residual_cohesion_kPa or "
             "residual_undrained_strength_kPa");
  if (angle) {
    s.phi = radians(*angle);
    m.residual_angle_deg = *angle;
  }
  s.c = undrained ? strength : cohesion;
}

void read_extent(ObjectReader& in, Softening& s) {
  in.optional_number("displacement_m", s.displacement, {"m", 0.0, 1000.0, true},
                     {"Displacement across a shear band over which the strength falls from peak to residual, linearly; "
                      "run-outs then do not depend on the particle spacing. Give this or plastic_shear_strain.",
                      "ring shear test", "none"});
  in.optional_number(
      "band_width_m", s.band_width, {"m", 0.0, 100.0, true},
      {"Width of a shear band, over which plastic strains are averaged: a length that no spacing changes. "
       "State at least two of the coarsest particle spacings; a smaller one counts as that.",
       "numerical", "two particle spacings"});
  in.optional_number("plastic_shear_strain", s.shear_strain, {"", 0.0, 1000.0, true},
                     {"Plastic shear strain over which it falls, whatever the spacing: run-outs then depend on it.",
                      "to repeat computations that state it so", "none"});
  in.one_form({{{"displacement_m"}, {"band_width_m"}}, {{"plastic_shear_strain"}, {}}});
  if (s.shear_strain && s.band_width) in.fault("band_width_m", "has no meaning beside plastic_shear_strain");
  if (s.displacement && s.shear_strain)
    in.fault("plastic_shear_strain", "is given beside displacement_m; give one of the two");
  if (!s.displacement && !s.shear_strain && in.find("displacement_m") == nullptr &&
      in.find("plastic_shear_strain") == nullptr)
    in.fault("displacement_m", "is missing (or plastic_shear_strain)");
}

}  // namespace

void read_strength(ObjectReader& in, MaterialInput& m) {
  const bool undrained = any_given(in, undrained_keys);
  const bool drained = in.find("friction_angle_deg") != nullptr || any_given(in, cohesion_keys);
  const bool inherits_strength = !m.undrained;
  if (undrained)
    become_undrained(m);
  else if (drained)
    become_drained(m);
  std::optional<double> angle;
  in.optional_number("friction_angle_deg", angle, friction_angle_range,
                     {"Friction angle phi of the yield stress c + p tan(phi); the median if the random field has no "
                      "log_mean.",
                      "laboratory; [Z20] Eq. 5", "none, required unless undrained_strength_kPa or _Pa is given"});
  if (in.requires_keys()) in.one_form({{{"friction_angle_deg"}}, {{undrained_keys[0]}}, {{undrained_keys[1]}}});
  const bool missing = in.find("friction_angle_deg") == nullptr && !m.undrained;
  if (missing && (in.requires_keys() || !inherits_strength))
    in.fault("friction_angle_deg", "is missing; " + friction_angle_range.describe());
  if (angle) m.friction_angle_deg = *angle;
  m.phi = radians(m.friction_angle_deg);
  double cohesion = m.undrained ? 0.0 : m.c;
  if (!m.undrained) in.record("friction_angle_deg", m.friction_angle_deg);
  in.number_in_either("cohesion_Pa", cohesion, strength_Pa,
                      {"Cohesion c of the yield stress.", "laboratory; [Z20] Eq. 5"}, false,
                      {"cohesion_kPa", strength_kPa, 1000.0, {"The same in kPa.", "laboratory", "none"}});
  if (m.undrained)
    in.remove_record("cohesion_Pa");
  else
    m.c = cohesion;
  read_undrained_strength(in, m);
  std::optional<double> r_u;
  in.optional_number("r_u", r_u, {"", 0.0, 1.0},
                     {"Pore pressure before the slide over the total vertical stress; the soil carries the pressure "
                      "along. 0: dry, also "
                      "below the line of water.",
                      "Bishop & Morgenstern 1960", "that of the line of water; dry without one"});
  if (r_u) m.r_u = r_u;
  if (m.r_u && !m.undrained) in.record("r_u", *m.r_u);
  for (const char* undrained_key : undrained_keys) {
    for (const char* key : {"friction_angle_deg", "cohesion_Pa", "cohesion_kPa", "r_u", "mu_i"})
      in.exclude(key, undrained_key);
  }
}

void read_softening(ObjectReader& in, MaterialInput& m) {
  const bool own = in.find("softening") != nullptr;
  in.object("softening", "Loss of strength from peak to residual as the soil shears; with rheology.yield elastic.",
            Absent::skip, [&](ObjectReader& section) {
              Softening s;
              read_residuals(section, m, s);
              read_extent(section, s);
              m.softening = s;
            });
  if (!m.softening) return;
  const Softening& s = *m.softening;
  if (s.phi)
    check_residual(in, "residual_friction_angle_deg", m.residual_angle_deg, "friction_angle_deg", m.friction_angle_deg,
                   own);
  if (s.c && m.c_gradient == 0.0)
    check_residual(in, m.undrained ? "residual_undrained_strength_Pa" : "residual_cohesion_Pa", *s.c,
                   m.undrained ? undrained_keys[0] : "cohesion_Pa", m.c, own);
}

void read_water(ObjectReader& in, Water& w, const std::filesystem::path& directory, SourceLocations& origins) {
  origins.water =
      read_vertices(in, "phreatic_line", {2, most_vertices}, directory,
                    {"Phreatic line, from left to right over the whole slide: the water pressure is 0 on it, "
                     "and that of seepage parallel to it below, hydrostatic where it is level. Not above the "
                     "ground.",
                     "piezometers"});
  in.one_form({{{"phreatic_line_m"}}, {{"phreatic_line_csv"}}});
  origins.note_file(origins.water);
  const Vertices& line = origins.water;
  for (std::size_t k = 1; k < line.points.size(); ++k)
    if (line.points[k].x <= line.points[k - 1].x) {
      in.faults().add(line.location(k), "x = " + to_text(line.points[k].x) + " does not exceed the x before it, " +
                                            to_text(line.points[k - 1].x) + ": a water line runs from left to right");
      return;
    }
  w.line = line.points;
  if (!line.empty()) in.record("phreatic_line_m", to_json(line.points));
  double unit_weight = 9.81;
  in.number("unit_weight_kN_m3", unit_weight, {"kN/m3", 9.0, 13.0},
            {"Unit weight of the water at 9.81 m/s2, whatever gravity_m_s2 is.", "9.81; up to 12 for brine"});
  w.density = unit_weight * 1000.0 / laboratory_gravity;
  in.choice(
      "in_motion", w.in_motion, motions,
      {"What becomes of the water while the soil moves. carried: undrained, each particle keeps its ratio of pore "
       "pressure to total stress.",
       "solver/material/README.md"});
}

}  // namespace talus
