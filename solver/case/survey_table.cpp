#include "case/survey_table.hpp"

#include <algorithm>
#include <cctype>
#include <span>

#include "case/survey_text.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

constexpr std::string_view feet[] = {"ft", "feet"};
constexpr std::string_view metres[] = {"m", "metre", "metres", "meter", "meters"};
constexpr const char* names_allowed =
    "distance: x, distance, chainage, station or offset; elevation: y, z, elevation or height";

/// A heading such as "Elevation (m)" or chainage_m: its name in lower case and its unit.
struct Heading {
  std::string name, unit;

  explicit Heading(std::string_view cell) {
    const std::vector<std::string> words = words_of(cell);
    name = words.front();
    unit = words.size() > 1 ? words[1] : "";
    const bool bracketed = cell.find_first_of("([") != std::string_view::npos;
    if (!bracketed && words.size() > 1 && !unit.empty() && unit != "m" && !is_other_unit(unit)) name.clear();
  }
};

struct Columns {
  std::size_t x = 0, y = 1;
  std::string x_name = "1", y_name = "2";
  std::size_t most = 2;  ///< cells that a row may have
};

/// Columns of the two quantities among the headings; more than one of a kind where it cannot be told.
struct Found {
  std::vector<std::size_t> x, y;

  explicit Found(const std::vector<std::string>& cells) {
    std::vector<std::string> names;
    for (const std::string& cell : cells) names.push_back(Heading(cell).name);
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (contains(distance_names, names[k])) x.push_back(k);
      if (contains(elevation_names, names[k])) y.push_back(k);
    }
    const auto named = [&](std::string_view name) { return std::ranges::count(names, name) == 1; };
    if (!named("x") || !named("y") || y.size() != 1) return;
    x = {static_cast<std::size_t>(std::ranges::find(names, "x") - names.begin())};
  }
  bool some() const { return !x.empty() || !y.empty(); }
  bool both() const { return !x.empty() && !y.empty(); }
  bool ambiguous() const { return x.size() > 1 || y.size() > 1; }
};

std::string list_of(const std::vector<std::string>& cells) {
  std::string list;
  for (const std::string& cell : cells) list += (list.empty() ? "" : ", ") + in_quotes(cell);
  return shorten(list, 200);
}

/// A table as lines of cells: headings first, then from `first_row` on numbers.
struct Table {
  char separator;
  std::vector<TableLine> lines;
  std::size_t first_row = 0;

  std::vector<std::string> cells(std::size_t k) const { return cells_of(lines[k].text, separator); }
};

/// Refuses what is not in metres, or no elevation: by a heading, a line of units beneath it, or a title.
bool refuse_headings(const Table& table, Columns columns, LineFaults& found) {
  const auto refuse = [&](std::size_t k, const std::string& message) {
    found.add("heading", table.lines[k].number, message);
    return true;
  };
  for (std::size_t k = 0; k < table.first_row; ++k) {
    const std::vector<std::string> cells = table.cells(k), words = words_of(table.lines[k].text);
    for (const std::size_t c : {columns.x, columns.y}) {
      if (c >= cells.size() || cells.size() < 2) continue;
      const std::string unit = other_unit(cells[c]);
      if (!unit.empty()) return refuse(k, "column " + in_quotes(cells[c]) + " is in " + unit + "; metres are needed");
    }
    if (!first_of(words, feet).empty() && first_of(words, metres).empty())
      return refuse(k, in_quotes(table.lines[k].text) + " names feet; metres are needed");
    if (columns.y < cells.size() && cells.size() >= 2 && !first_of(words_of(cells[columns.y]), depth_names).empty())
      return refuse(k, "column " + in_quotes(cells[columns.y]) +
                           " is a depth or a thickness; the elevation is needed, upwards in metres");
  }
  return false;
}

/// What a file without a row of two numbers holds in its first line that has a digit.
std::string no_rows_message(const std::vector<TableLine>& lines) {
  const std::string message =
      "has no row of two numbers, distance and elevation in metres, separated by comma, semicolon, tab or blanks";
  const auto is_digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  const auto line = std::ranges::find_if(
      lines, [&](const TableLine& l) { return !l.comment && std::ranges::any_of(l.text, is_digit); });
  if (line == lines.end()) return message;
  return message + "; line " + std::to_string(line->number) + " reads " + in_quotes(line->text) +
         (has_station(line->text) ? no_stations : "");
}

/// The two columns, or nothing and a fault.
std::optional<Columns> choose_columns(const Table& table, LineFaults& found) {
  const std::size_t count = table.cells(table.first_row).size();
  Columns columns;
  bool named = false;
  for (std::size_t k = table.first_row; k-- > 0 && !named;) {
    const std::vector<std::string> cells = table.cells(k);
    if (cells.size() < count || cells.size() < 2) continue;
    const Found headings(cells);
    if (headings.both() && headings.ambiguous()) {
      found.add("columns", table.lines[k].number,
                "has several columns of distance or elevation: " + list_of(cells) + "; keep one of each (" +
                    names_allowed + ")");
      return {};
    }
    if (headings.both())
      columns = {headings.x[0], headings.y[0], "", "", std::max(cells.size(), count)};
    else if (cells.size() == 2 && headings.some() && !headings.ambiguous())
      columns =
          headings.y.empty() ? Columns{headings.x[0], 1 - headings.x[0]} : Columns{1 - headings.y[0], headings.y[0]};
    named = headings.both() || (cells.size() == 2 && headings.some());
    if (named) columns.x_name = in_quotes(cells[columns.x]);
    if (named) columns.y_name = in_quotes(cells[columns.y]);
  }
  if (!named && count != 2) {
    found.add("columns", table.lines[table.first_row].number,
              "has " + std::to_string(count) + " columns and no header that names two of them (" + names_allowed +
                  (table.separator == ',' ? "); decimal commas need another separator than a comma" : ")"));
    return {};
  }
  if (refuse_headings(table, columns, found)) return {};
  return columns;
}

std::string form_of(const Columns& columns, char separator, bool decimal_commas) {
  return "columns " + columns.x_name + " and " + columns.y_name + ", separated by " + separator_name(separator) +
         (decimal_commas ? ", decimal commas" : "");
}

}  // namespace

bool has_station(std::string_view text) {
  const auto is_digit = [&](std::size_t k) {
    return k < text.size() && std::isdigit(static_cast<unsigned char>(text[k])) != 0;
  };
  for (std::size_t k = text.find('+'); k != std::string_view::npos; k = text.find('+', k + 1))
    if (k > 0 && is_digit(k - 1) && is_digit(k + 1)) return true;
  return false;
}

void LineFaults::add(std::string_view kind, int line, const std::string& message) {
  const auto known = std::ranges::find(kinds_, kind, &Kind::name);
  if (known != kinds_.end())
    ++known->more;
  else
    kinds_.push_back({kind, line, message});
}

void LineFaults::report(Faults& faults) const {
  for (const Kind& kind : kinds_) {
    const std::string place = kind.first_line > 0 ? file_ + ":" + std::to_string(kind.first_line) : file_;
    const std::string more = kind.more == 0 ? "" : " (and " + std::to_string(kind.more) + " more line";
    faults.add(place, kind.message + more + (kind.more == 0 ? "" : kind.more == 1 ? ")" : "s)"));
  }
}

SurveyTable read_survey_table(std::string_view text, std::size_t most, LineFaults& found) {
  constexpr std::size_t most_headings = 1000;
  Table table{',', lines_of(text, most + most_headings)};
  const std::optional<char> separator = find_separator(table.lines);
  if (!separator) {
    found.add("empty", 0, no_rows_message(table.lines));
    return {};
  }
  table.separator = *separator;
  while (table.lines[table.first_row].comment || !is_row_of_numbers(table.cells(table.first_row))) ++table.first_row;
  const std::optional<Columns> columns = choose_columns(table, found);
  if (!columns) return {};

  const std::size_t needed = std::max(columns->x, columns->y) + 1;
  std::vector<SurveyRow> rows;
  bool points = false, commas = false;
  for (std::size_t k = 0; k < table.lines.size() && rows.size() < most; ++k) {
    const TableLine& line = table.lines[k];
    if (line.comment) continue;
    const std::vector<std::string> cells = table.cells(k);
    const bool whole = cells.size() >= needed;
    if (k < table.first_row && (!whole || (!is_number(cells[columns->x]) && !is_number(cells[columns->y])))) continue;
    if (!whole || (cells.size() > columns->most && k >= table.first_row)) {
      if (cells.empty() && line.text.find('"') == std::string_view::npos) continue;  // separators alone
      if (cells.empty())
        found.add("quote", line.number, "has a quotation mark that is not closed");
      else
        found.add("count", line.number,
                  "has " + std::to_string(cells.size()) + (cells.size() == 1 ? " column" : " columns") + ", expected " +
                      std::to_string(columns->most));
      continue;
    }
    SurveyRow row{line.number, cells[columns->x], cells[columns->y]};
    for (std::string* cell : {&row.x, &row.y}) {
      commas = commas || (*separator != ',' && has_decimal_comma(*cell) && is_number(*cell));
      points = points || (cell->find('.') != std::string::npos && is_number(*cell));
      *cell = with_point(*cell);
    }
    if (commas && points)
      found.add("decimals", line.number, "mixes decimal points and decimal commas, or has separators of thousands");
    rows.push_back(std::move(row));
  }
  return {std::move(rows), form_of(*columns, *separator, commas)};
}

}  // namespace talus
