#pragma once
// Tables of measured values: where, what, and with which standard error.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "case/survey_table.hpp"
#include "random_field/property_spec.hpp"

namespace talus {

/// A row and the cells of its columns.
struct DataRow {
  int line;                          ///< of the file, counted from 1
  std::array<std::string, 4> cells;  ///< x, y, value, standard error; the last one is empty where there is no column
};

/// What was read of a table.
struct DataTable {
  std::vector<DataRow> rows;
  std::string form;  ///< columns "x", "y", "value" and "error", separated by semicolons, decimal commas
};

/// Position, value and standard error of every row, as text with a decimal point.
/// - Separators, decimal commas, comments and ends of lines: as read_survey_table takes them.
/// - Lines before the first row of three numbers are headers. Columns are found by a word of their heading, in any
/// case:
///   x, distance, chainage, station or offset; y, z, elevation or height; value or a word for the property (friction or
///   phi, cohesion or c, weight or gamma, viscosity or eta); error, stdev, se or uncertainty (may be missing). Columns
///   that name another property, and errors of it, are left to that one: a log may hold several. Three or four columns
///   without names are x, y, value and error.
/// @param most      rows that are read at most
/// @param property  that is wanted
/// @param found  returns what cannot be read; no rows then
DataTable read_data_table(std::string_view text, std::size_t most, Property property, LineFaults& found);

}  // namespace talus
