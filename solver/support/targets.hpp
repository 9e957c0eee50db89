#pragma once
// What a slide does to the places that a case names, declared once: result.json, the columns of realizations.csv, the
// rows of talusd, study.json and the statistics of a target follow from this table.

#include <array>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace talus {

/// A point and a stretch of the ground are observed only; a structure is an obstacle, whose load is measured too.
enum class TargetKind { point, stretch, structure };
inline constexpr std::array target_kind_words{"point", "stretch", "structure"};
constexpr const char* word(TargetKind kind) { return target_kind_words[static_cast<std::size_t>(kind)]; }

/// A target as plans and tables know it.
struct TargetName {
  std::string name;
  TargetKind kind = TargetKind::point;
  bool operator==(const TargetName&) const = default;
};

/// What one run did to one target. Loads are per metre of width; horizontal ones count in the direction of the slide,
/// vertical ones downwards.
struct TargetOutcome {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();

  TargetName of;
  bool arrives = false;     ///< the flow was once as thick there as the target's threshold
  bool open = false;        ///< the run ended before that was decided, or before the flow at the target came to rest
  double arrival = none;    ///< when the flow first was that thick [s]; NaN: never
  double peak_depth = 0.0;  ///< largest thickness of the flow, measured vertically [m]
  double peak_speed = 0.0;  ///< largest depth-averaged speed of flow at least as thick as the threshold [m/s]
  double peak_dynamic_pressure = 0.0;     ///< largest depth average of rho v^2 of such flow [Pa]
  double final_depth = 0.0;               ///< at the end of the run [m]
  double peak_horizontal_force = none;    ///< largest mean over the averaging time, >= 0 [N/m]; NaN: no structure
  double peak_downward_force = none;      ///< the same [N/m]
  double peak_overturning_moment = none;  ///< the same, about the foot on the side to which the slide goes [N m/m]
  double final_horizontal_force = none;   ///< mean over the last whole averaging time [N/m]
  double horizontal_impulse = none;       ///< of the whole run [N s/m]
  double downward_impulse = none;         ///< of the whole run [N s/m]
};

/// A number of a target as files, tables and figures know it.
struct TargetNumber {
  const char* key;  ///< after the name and a dot it is a column of the tables and the name of a quantity
  const char* unit;
  const char* label;  ///< for figures and tables
  double TargetOutcome::*member;
  bool structures_only = false;
  bool optional = false;  ///< a run may have no value: NaN, and null in result.json
};
inline constexpr std::array target_numbers{
    TargetNumber{"arrival_s", "s", "time of arrival", &TargetOutcome::arrival, false, true},
    TargetNumber{"peak_depth_m", "m", "peak depth", &TargetOutcome::peak_depth},
    TargetNumber{"peak_speed_m_s", "m/s", "peak speed", &TargetOutcome::peak_speed},
    TargetNumber{"peak_dynamic_pressure_Pa", "Pa", "peak dynamic pressure", &TargetOutcome::peak_dynamic_pressure},
    TargetNumber{"final_depth_m", "m", "final depth", &TargetOutcome::final_depth},
    TargetNumber{"peak_horizontal_force_N_m", "N/m", "peak horizontal force", &TargetOutcome::peak_horizontal_force,
                 true},
    TargetNumber{"peak_downward_force_N_m", "N/m", "peak downward force", &TargetOutcome::peak_downward_force, true},
    TargetNumber{"peak_overturning_moment_Nm_m", "N m/m", "peak overturning moment",
                 &TargetOutcome::peak_overturning_moment, true},
    TargetNumber{"final_horizontal_force_N_m", "N/m", "final horizontal force", &TargetOutcome::final_horizontal_force,
                 true},
    TargetNumber{"horizontal_impulse_Ns_m", "N s/m", "horizontal impulse", &TargetOutcome::horizontal_impulse, true},
    TargetNumber{"downward_impulse_Ns_m", "N s/m", "downward impulse", &TargetOutcome::downward_impulse, true}};

/// Whether a target of this kind has the number.
constexpr bool has_number(TargetKind kind, const TargetNumber& number) {
  return kind == TargetKind::structure || !number.structures_only;
}

/// The number of a key; null where there is none.
constexpr const TargetNumber* find_target_number(std::string_view key) {
  for (const TargetNumber& number : target_numbers)
    if (number.key == key) return &number;
  return nullptr;
}

/// Columns of the tables beside the numbers.
constexpr const char* arrives_key = "arrives";  ///< column: 1 or 0
constexpr const char* open_key = "open";        ///< column: 1 or 0

}  // namespace talus
