#pragma once
// The scalar measures of a run, declared once: result.json, realizations.csv, the SQL columns of talusd, study.json,
// `talus stats`, the histograms of talusd and their schemas follow from this table.
//
// A new measure is a member of Measures, a line in the table, its computation (simulation/observables.cpp) and a test.

#include <array>
#include <optional>
#include <string_view>

namespace talus {

/// Where the slide ended; run-outs along x, in the direction of the slide. [m]
struct Measures {
  double influence_zone = 0.0;    ///< farthest soil particle, the paper's measure
  double front_connected = 0.0;   ///< farthest particle of the largest body linked by gaps of at most 1.5 dx
  double front_mass_99 = 0.0;     ///< beyond it lies 1 % of the mass
  double front_mass_999 = 0.0;    ///< beyond it lies 0.1 % of the mass
  double centre_of_mass_x = 0.0;  ///< mean x of the mass
  /// Farthest place of the largest body where the soil has a given thickness; NaN: nowhere
  double front_at_thickness = 0.0;
};

/// A measure as files, tables and figures know it.
struct Measure {
  const char* key;           ///< in every file, as SQL column and as name of the quantity
  const char* unit;          ///< "m"
  const char* label;         ///< for figures and tables
  bool front;                ///< a run-out distance: histogram edges that a case gives apply to it
  double Measures::*member;  ///< where a run keeps it
  bool later = false;        ///< added after version 0.1.0: its tables do not have it
  bool optional = false;     ///< a run may have no value: NaN, and null in result.json
};

/// The first one, the paper's, is the default of every question about "the" quantity.
inline constexpr std::array measure_table{
    Measure{"influence_zone_m", "m", "farthest particle", true, &Measures::influence_zone},
    Measure{"front_connected_m", "m", "connected body", true, &Measures::front_connected},
    Measure{"front_mass_99_m", "m", "99 % of the mass", true, &Measures::front_mass_99},
    Measure{"front_mass_999_m", "m", "99.9 % of the mass", true, &Measures::front_mass_999},
    Measure{"centre_of_mass_x_m", "m", "centre of mass", false, &Measures::centre_of_mass_x},
    Measure{"front_at_thickness_m", "m", "fixed thickness", true, &Measures::front_at_thickness, true, true}};

/// The measure of a key; null where there is none.
constexpr const Measure* find_measure(std::string_view key) {
  for (const Measure& measure : measure_table)
    if (key == measure.key) return &measure;
  return nullptr;
}

/// The measure that summaries state first. The farthest particle may be a single one that was thrown ahead, by 15 m and
/// more over ledges; 1 % of the mass is many particles at every spacing.
inline constexpr const Measure& leading_measure = *find_measure("front_mass_99_m");

/// The order in which summaries show the measures: the leading one, then the others as in the table.
constexpr std::array<const Measure*, measure_table.size()> reading_order() {
  std::array<const Measure*, measure_table.size()> order{&leading_measure};
  std::size_t next = 1;
  for (const Measure& measure : measure_table)
    if (&measure != &leading_measure) order[next++] = &measure;
  return order;
}

}  // namespace talus
