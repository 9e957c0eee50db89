#pragma once
// Lines, cells and words of tables that people write: what the readers of such tables have in common.

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace talus {

using WordList = std::span<const std::string_view>;
inline constexpr std::string_view distance_names[] = {"x", "distance", "chainage", "station", "offset"};
inline constexpr std::string_view elevation_names[] = {"y", "z", "elevation", "height"};
inline constexpr std::string_view depth_names[] = {"depth",      "depths", "thickness", "cover",
                                                   "overburden", "below",  "bgl",       "mbgl"};

bool contains(WordList names, std::string_view word);

/// A line that is not blank.
struct TableLine {
  int number;  ///< counted from 1
  std::string_view text;
  bool comment;  ///< it began with #, which is taken off
};

/// The lines that are not blank, `most` of them at most; those that end with CR alone are lines as well.
std::vector<TableLine> lines_of(std::string_view text, std::size_t most);

/// Cells of a line; empty ones at its end, as spreadsheets leave them, are dropped.
std::vector<std::string> cells_of(std::string_view line, char separator);

/// Whether the cell holds a decimal comma: digits, one comma, no point.
bool has_decimal_comma(std::string_view cell);

/// The cell with a decimal point.
std::string with_point(std::string cell);

bool is_number(const std::string& cell);

/// Whether at least so many cells are numbers.
bool is_row_of_numbers(const std::vector<std::string>& cells, std::ptrdiff_t least = 2);

/// The separator that gives the most rows of at least so many numbers, and nothing where none gives any. A comma comes
/// last: in the others it may be a decimal comma.
std::optional<char> find_separator(const std::vector<TableLine>& lines, std::ptrdiff_t least = 2);

/// Words of letters and digits, in lower case; at least one, which may be empty.
std::vector<std::string> words_of(std::string_view text);

/// The first of the words that is among the names, or "".
std::string first_of(const std::vector<std::string>& words, WordList names);

/// The unit other than metres that a heading names, or "". "in" is a unit only at the end; x' may be feet.
std::string other_unit(std::string_view cell);

/// Whether the word is a unit other than metres.
bool is_other_unit(std::string_view word);

/// A separator in words: "semicolons".
std::string separator_name(char separator);

}  // namespace talus
