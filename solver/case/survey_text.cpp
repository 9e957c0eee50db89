#include "case/survey_text.hpp"

#include <algorithm>
#include <cctype>

#include "support/csv.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

constexpr std::string_view other_units[] = {"mm", "cm", "dm", "km", "ft", "feet", "in", "inch", "yd", "mi", "miles"};

std::string_view without_blanks(std::string_view text) {
  constexpr std::string_view blanks = " \t";
  const std::size_t first = text.find_first_not_of(blanks);
  return first == std::string_view::npos ? std::string_view()
                                         : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

}  // namespace

bool contains(WordList names, std::string_view word) { return std::ranges::find(names, word) != names.end(); }

std::vector<TableLine> lines_of(std::string_view text, std::size_t most) {
  std::vector<TableLine> lines;
  for (int number = 1; !text.empty() && lines.size() < most; ++number) {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    std::string_view line = without_blanks(text.substr(0, end));
    text.remove_prefix(text.substr(end).starts_with("\r\n") ? end + 2 : std::min(end + 1, text.size()));
    const bool comment = line.starts_with('#');
    if (comment) line = without_blanks(line.substr(1));
    if (!line.empty()) lines.push_back({number, line, comment});
  }
  return lines;
}

std::vector<std::string> cells_of(std::string_view line, char separator) {
  std::vector<std::string> cells = split_fields(line, separator);
  for (std::string& cell : cells) cell = without_blanks(cell);
  while (!cells.empty() && cells.back().empty()) cells.pop_back();
  return cells;
}

bool has_decimal_comma(std::string_view cell) {
  const std::size_t comma = cell.find(',');
  return comma != std::string_view::npos && comma > 0 && std::isdigit(static_cast<unsigned char>(cell[comma - 1])) &&
         cell.find_first_of(",.", comma + 1) == std::string_view::npos && cell.find('.') == std::string_view::npos;
}

std::string with_point(std::string cell) {
  if (has_decimal_comma(cell)) cell[cell.find(',')] = '.';
  return cell;
}

bool is_number(const std::string& cell) { return to_number(with_point(cell)).has_value(); }

bool is_row_of_numbers(const std::vector<std::string>& cells, std::ptrdiff_t least) {
  return std::ranges::count_if(cells, is_number) >= least;
}

std::optional<char> find_separator(const std::vector<TableLine>& lines, std::ptrdiff_t least) {
  std::optional<char> best;
  std::ptrdiff_t most = 0;
  for (const char separator : {';', '\t', ' ', ','}) {
    const auto rows = std::ranges::count_if(lines, [&](const TableLine& line) {
      return !line.comment && is_row_of_numbers(cells_of(line.text, separator), least);
    });
    if (rows > most) {
      most = rows;
      best = separator;
    }
  }
  return best;
}

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words(1);
  for (const char c : text) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || (static_cast<unsigned char>(c) & 0x80U) != 0)
      words.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    else if (!words.back().empty())
      words.emplace_back();
  }
  if (words.size() > 1 && words.back().empty()) words.pop_back();
  return words;
}

std::string first_of(const std::vector<std::string>& words, WordList names) {
  const auto found = std::ranges::find_if(words, [&](const std::string& word) { return contains(names, word); });
  return found == words.end() ? "" : *found;
}

std::string other_unit(std::string_view cell) {
  std::vector<std::string> words = words_of(cell);
  if (cell.ends_with('\'')) return "feet (')";
  const bool inches = words.back() == "in";
  std::erase(words, "in");
  const std::string unit = first_of(words, other_units);
  return unit.empty() && inches ? "in" : unit;
}

bool is_other_unit(std::string_view word) { return contains(other_units, word); }

std::string separator_name(char separator) {
  return separator == ';' ? "semicolons" : separator == '\t' ? "tabs" : separator == ' ' ? "blanks" : "commas";
}

}  // namespace talus
