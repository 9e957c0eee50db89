#include "case/data_table.hpp"

#include <algorithm>

#include "case/survey_text.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

constexpr std::string_view value_names[] = {"value"};
/// Words in the heading of a property's column, besides it.
constexpr std::array<std::array<std::string_view, 2>, property_count> property_words{
    {{"friction", "phi"}, {"cohesion", "c"}, {"weight", "gamma"}, {"viscosity", "eta"}}};
constexpr std::string_view error_names[] = {"error", "stdev", "se", "uncertainty"};
constexpr std::string_view radian_names[] = {"rad", "radian", "radians"};
constexpr std::size_t none = static_cast<std::size_t>(-1);
constexpr std::size_t another = 4;  ///< kind of a column that holds another property, or its error

std::string names_allowed(Property property) {
  const auto& [name, symbol] = property_words[index_of(property)];
  return "x, distance, chainage, station or offset; y, z, elevation or height; value, " + std::string(name) + " or " +
         std::string(symbol) + "; error, stdev, se or uncertainty";
}

using Cells = std::vector<std::string>;

/// Which column holds what; none: there is no such column.
struct Columns {
  std::array<std::size_t, 4> of{none, none, none, none};
  std::array<std::string, 4> names;
  bool others = false;  ///< there are columns of other properties

  bool complete() const { return of[0] != none && of[1] != none && of[2] != none; }
  bool lacks_only_value() const { return of[0] != none && of[1] != none && of[2] == none; }
  std::size_t needed() const { return std::max({of[0], of[1], of[2]}) + 1; }
};

/// Whether a heading names a property.
bool names_property(const std::vector<std::string>& words, std::size_t property) {
  return !first_of(words, property_words[property]).empty();
}

/// What a heading stands for: the index in Columns, another, or none. "error of phi" is an error.
std::size_t kind_of(const std::string& heading, Property property) {
  const std::vector<std::string> words = words_of(heading);
  const WordList names[] = {distance_names, elevation_names};
  const bool own = names_property(words, index_of(property));
  for (std::size_t p = 0; p < property_count; ++p)
    if (!own && names_property(words, p)) return another;
  if (!first_of(words, error_names).empty()) return 3;
  if (own || !first_of(words, value_names).empty()) return 2;
  for (std::size_t k = 0; k < 2; ++k)
    if (contains(names[k], words.front())) return k;
  if (!first_of(words, depth_names).empty()) return 1;  // which is refused
  return none;
}

/// Columns by their headings, where the line names a position and a value; a fault where it names one twice.
Columns named_columns(const Cells& cells, int line, Property property, LineFaults& found) {
  Columns columns;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const std::size_t kind = kind_of(cells[k], property);
    columns.others = columns.others || kind == another;
    if (kind == none || kind == another) continue;
    if (columns.of[kind] != none) {
      found.add("columns", line,
                "has two columns of one kind, " + in_quotes(columns.names[kind]) + " and " + in_quotes(cells[k]) +
                    "; keep one of each (" + names_allowed(property) + ")");
      return {};
    }
    columns.of[kind] = k;
    columns.names[kind] = cells[k];
  }
  return columns;
}

/// Refuses positions that are not in metres or are depths, and angles in radians.
void check_units(const Columns& columns, int line, LineFaults& found) {
  for (std::size_t k = 0; k < 2; ++k)
    if (const std::string unit = other_unit(columns.names[k]); !unit.empty())
      found.add("heading", line, "column " + in_quotes(columns.names[k]) + " is in " + unit + "; metres are needed");
  if (!first_of(words_of(columns.names[1]), depth_names).empty())
    found.add("heading", line,
              "column " + in_quotes(columns.names[1]) + " is a depth; the elevation is needed, upwards in metres");
  for (std::size_t k = 2; k < 4; ++k)
    if (!first_of(words_of(columns.names[k]), radian_names).empty())
      found.add("heading", line, "column " + in_quotes(columns.names[k]) + " is in radians; degrees are needed");
}

std::string form_of(const Columns& columns, char separator, bool commas) {
  std::string names;
  for (std::size_t k = 0; k < 4; ++k)
    if (columns.of[k] != none)
      names += (names.empty() ? "" : ", ") +
               (columns.names[k].empty() ? std::to_string(columns.of[k] + 1) : in_quotes(columns.names[k]));
  return "columns " + names + ", separated by " + separator_name(separator) + (commas ? ", decimal commas" : "");
}

/// The columns, from the nearest line of headings above the first row, or in the order x, y, value, error.
Columns choose_columns(const std::vector<TableLine>& lines, std::size_t first, char separator, Property property,
                       LineFaults& found) {
  for (std::size_t k = first; k-- > 0;) {
    const Columns columns = named_columns(cells_of(lines[k].text, separator), lines[k].number, property, found);
    if (columns.lacks_only_value() && columns.others) {
      found.add("columns", lines[k].number, "has no column of this property (" + names_allowed(property) + ")");
      return {};
    }
    if (!columns.complete()) continue;
    check_units(columns, lines[k].number, found);
    return columns;
  }
  Columns columns;
  const std::size_t count = cells_of(lines[first].text, separator).size();
  if (count == 3 || count == 4)
    for (std::size_t k = 0; k < count; ++k) columns.of[k] = k;
  else
    found.add("columns", lines[first].number,
              "has " + std::to_string(count) + " columns and no header that names position and value (" +
                  names_allowed(property) + ")");
  return columns;
}

}  // namespace

DataTable read_data_table(std::string_view text, std::size_t most, Property property, LineFaults& found) {
  constexpr std::size_t most_headings = 1000;
  const std::vector<TableLine> lines = lines_of(text, most + most_headings);
  const std::optional<char> separator = find_separator(lines, 3);
  if (!separator) {
    found.add("empty", 0,
              "has no row of three numbers, x and y in metres and the value, separated by comma, semicolon, tab or "
              "blanks; decimal commas need another separator than a comma");
    return {};
  }
  std::size_t first = 0;
  while (lines[first].comment || !is_row_of_numbers(cells_of(lines[first].text, *separator), 3)) ++first;
  const Columns columns = choose_columns(lines, first, *separator, property, found);
  if (!columns.complete()) return {};
  DataTable table;
  bool commas = false;
  for (std::size_t k = first; k < lines.size() && table.rows.size() < most; ++k) {
    if (lines[k].comment) continue;
    const Cells cells = cells_of(lines[k].text, *separator);
    if (cells.size() < columns.needed()) {
      found.add("count", lines[k].number,
                "has " + std::to_string(cells.size()) + (cells.size() == 1 ? " column" : " columns") + ", at least " +
                    std::to_string(columns.needed()) + " are needed");
      continue;
    }
    DataRow row{lines[k].number, {}};
    for (std::size_t c = 0; c < 4; ++c) {
      if (columns.of[c] >= cells.size()) continue;
      const std::string& cell = cells[columns.of[c]];
      commas = commas || (*separator != ',' && has_decimal_comma(cell));
      row.cells[c] = with_point(cell);
    }
    table.rows.push_back(std::move(row));
  }
  table.form = form_of(columns, *separator, commas);
  return table;
}

}  // namespace talus
