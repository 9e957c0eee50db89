// The keys of walls: contact, slip, friction, and stretches of the bed with frictions of their own.

#include <algorithm>

#include "case/sections.hpp"
#include "math/angle.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

constexpr Names<WallContact> contacts[] = {{"always", WallContact::always}, {"approaching", WallContact::approaching}};
constexpr Names<WallSlip> slips[] = {
    {"no_slip", WallSlip::no_slip}, {"friction", WallSlip::friction}, {"free_slip", WallSlip::free_slip}};

void read_turbulence(ObjectReader& in, std::optional<double>& xi) {
  in.optional_number(
      "voellmy_xi_m_s2", xi, {"m/s2", 1.0, 1e5},
      {"Turbulence coefficient xi of Voellmy's law: density g v^2/xi is added to the friction, v the mean "
       "speed of the soil above; the cohesion of the wall is then 0 unless given.",
       "back-analysis; Voellmy 1955, Salm 1993", "none, no such term"});
}

/// x1 and x2 where both are sound and in order.
void read_ends(ObjectReader& in, WallStretch& stretch) {
  std::vector<double> x;
  in.numbers("x_m", x, coordinate, {2, 2}, {"[x1, x2], x1 < x2: where the stretch begins and ends.", "site"});
  if (x.size() != 2) return;
  if (x[0] >= x[1])
    in.faults().add(pointer_to(in.pointer("x_m"), 1),
                    "x2 = " + to_text(x[1]) + " does not exceed x1 = " + to_text(x[0]));
  stretch.x1 = x[0];
  stretch.x2 = x[1];
}

void check_stretches(ObjectReader& in, const Boundary& bed) {
  if (!in.faults().none_under(in.pointer("stretches"))) return;
  for (std::size_t b = 0; b < bed.stretches.size(); ++b) {
    const std::string here = pointer_to(pointer_to(in.pointer("stretches"), b), "x_m");
    for (std::size_t a = 0; a < b; ++a)
      if (bed.stretches[a].x1 < bed.stretches[b].x2 && bed.stretches[b].x1 < bed.stretches[a].x2)
        in.faults().add(here, "overlaps stretch " + std::to_string(a));
    if (bed.line.vertices.empty()) continue;
    const auto [left, right] = std::ranges::minmax(bed.line.vertices, {}, &Vec2::x);
    if (bed.stretches[b].x2 <= left.x || bed.stretches[b].x1 >= right.x)
      in.faults().add(here, "lies beyond the bed, x = " + to_text(left.x) + " to " + to_text(right.x));
  }
}

void read_stretches(ObjectReader& in, Boundary& bed) {
  in.objects("stretches", {1, 1000},
             {"Stretches of the bed with frictions of their own, whatever slip says; they do not overlap.", "site"},
             "One stretch of the bed.", [&](ObjectReader& section) {
               WallStretch stretch;
               double angle = 0.0;
               read_ends(section, stretch);
               section.required_number("friction_angle_deg", angle, friction_angle_range,
                                       {"Friction angle of the stretch.", "interface shear test"});
               stretch.phi = radians(angle);
               section.optional_number_in_either(
                   "cohesion_Pa", stretch.c, {"Pa", 0.0, 1e9},
                   {"Cohesion of the stretch.", "interface shear test", "the soil's, or 0 with voellmy_xi_m_s2"},
                   {"cohesion_kPa", {"kPa", 0.0, 1e6}, 1000.0, {"The same in kPa.", "interface shear test", "none"}});
               read_turbulence(section, stretch.xi);
               bed.stretches.push_back(stretch);
             });
  if (in.find("stretches") == nullptr) in.remove_record("stretches");
  check_stretches(in, bed);
}

}  // namespace

void read_walls(ObjectReader& in, Walls& w, Boundary& bed) {
  in.choice(
      "contact", w.contact, contacts,
      {"always: a wall acts on every particle near it; approaching: only on particles that come nearer, which keeps "
       "a pile chattering.",
       "[Z20] section 2.1 for approaching"});
  in.choice("slip", bed.slip, slips,
            {"no_slip: velocity vanishes at the wall; friction: soil along the wall yields at the smaller "
             "friction angle and the smaller cohesion of wall and soil; free_slip: no shear.",
             "Takeda 1994, Morris 1997; Desai 1984 for friction"});
  std::optional<double> angle;
  in.optional_number(
      "friction_angle_deg", angle, friction_angle_range,
      {"Friction angle of the wall; needed by slip friction, unused otherwise.", "interface shear test", "none"});
  in.optional_number(
      "cohesion_Pa", bed.c, {"Pa", 0.0, 1e9},
      {"Cohesion of the wall with slip friction, unused otherwise; without it the soil's cohesion acts on "
       "the wall.",
       "interface shear test", "the soil's"});
  if (bed.slip == WallSlip::friction && in.find("friction_angle_deg") == nullptr)
    in.fault("friction_angle_deg",
             "is missing: slip \"friction\" needs the wall's angle; " + friction_angle_range.describe());
  bed.phi = radians(angle.value_or(0.0));
  read_turbulence(in, bed.xi);
  if (bed.xi && bed.slip != WallSlip::friction) in.fault("voellmy_xi_m_s2", "needs slip \"friction\"");
  read_stretches(in, bed);
  in.number("max_velocity_ratio", w.b_max, {"", 1.0, 100.0},
            {"Largest ratio of the mirrored velocity of a wall particle, b_max.", "Morris 1997"});
  in.integer("layers", w.layers, {"", 1.0, 20.0},
             {"Layers of wall particles; they must fill the kernel's support: at least 2 smoothing_ratio - 1/2.",
              "[Z20] section 3"});
}

}  // namespace talus
