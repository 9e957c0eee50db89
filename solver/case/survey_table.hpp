#pragma once
// Tables of numbers as surveys, spreadsheets and geographic information systems write them.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "support/faults.hpp"

namespace talus {

/// Faults of a table, one of each kind: the first, and in how many more lines there is another.
class LineFaults {
 public:
  explicit LineFaults(std::string file) : file_(std::move(file)) {}
  /// @param kind  what tells the faults apart
  void add(std::string_view kind, int line, const std::string& message);
  void report(Faults& faults) const;

 private:
  struct Kind {
    std::string_view name;
    int first_line;
    std::string message;
    std::size_t more = 0;
  };
  std::string file_;
  std::vector<Kind> kinds_;
};

/// Whether a text holds a station such as 1+125.00: digits, a plus sign and digits.
bool has_station(std::string_view text);
/// What to say of one, after its text.
inline constexpr const char* no_stations = ", a station; the distance must be one number, in metres";

/// A row and the cells of its two columns.
struct SurveyRow {
  int line;  ///< of the file, counted from 1
  std::string x, y;
};

/// What was read of a table.
struct SurveyTable {
  std::vector<SurveyRow> rows;
  std::string form;  ///< columns "chainage" and "elevation", separated by semicolons, decimal commas
};

/// The distance along the section and the elevation of every row, as text with a decimal point.
/// - Separators: semicolon, tab, blanks or comma, whichever gives the most rows of numbers. Decimal commas are read
///   where the separator is another. Lines end with LF, CRLF or CR; blank lines and # comments are skipped.
/// - Lines before the first row of numbers are headers. Columns are found by name, in any case, with or without a unit:
///   x, distance, chainage, station or offset; y, z, elevation or height. x and y go before the other names unless an
///   elevation is there too. Two columns without names are x and y.
/// @param most  rows that are read at most
/// @param found returns what cannot be read; no rows then
SurveyTable read_survey_table(std::string_view text, std::size_t most, LineFaults& found);

}  // namespace talus
