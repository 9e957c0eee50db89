#include "io/history.hpp"

#include <charconv>
#include <string_view>

#include "support/csv.hpp"
#include "support/error.hpp"
#include "support/files.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view first_header = "time_s,step,front_m,centre_of_mass_x_m,kinetic_energy_J_per_m,max_speed_m_s";
constexpr std::size_t terms = std::size(energy_terms), first_columns = 6, all_columns = first_columns + terms + 1;

const std::string& header() {
  static const std::string text = [] {
    std::string names(first_header);
    for (const EnergyTerm& term : energy_terms) names += std::string(",") + term.key;
    return names + ",created_J_m";
  }();
  return text;
}

bool parse(const std::vector<std::string>& fields, std::size_t columns, HistoryRow& row) {
  if (fields.size() != columns) return false;
  const auto number = [&](std::size_t i, auto& value) {
    const char* end = fields[i].data() + fields[i].size();
    const auto [stop, error] = std::from_chars(fields[i].data(), end, value);
    return error == std::errc() && stop == end;
  };
  bool good = number(0, row.time) && number(1, row.step) && number(2, row.front) && number(3, row.centre_of_mass_x) &&
              number(4, row.kinetic_energy) && number(5, row.max_speed);
  if (columns == first_columns) return good;
  for (std::size_t i = 0; i < terms; ++i) good = good && number(first_columns + i, row.energy.*energy_terms[i].value);
  double created = 0.0;  // follows from the others
  return good && number(columns - 1, created);
}

std::string line_of(const HistoryRow& row) {
  std::string line = to_text(row.time) + "," + std::to_string(row.step) + "," + to_text(row.front) + "," +
                     to_text(row.centre_of_mass_x) + "," + to_text(row.kinetic_energy) + "," + to_text(row.max_speed);
  for (const EnergyTerm& term : energy_terms) line += "," + to_text(row.energy.*term.value);
  return line + "," + to_text(row.energy.created()) + "\n";
}

}  // namespace

void write_history(const fs::path& path, std::span<const HistoryRow> rows) {
  std::string text = header() + "\n";
  for (const HistoryRow& row : rows) text += line_of(row);
  write_file_atomically(path, text);
}

std::vector<HistoryRow> read_history(const fs::path& path) {
  constexpr std::size_t max_bytes = std::size_t{1} << 30;
  const std::string content = read_file(path, max_bytes);
  CsvRows lines(content);
  if (!lines.next()) throw_at_line(path, 1, "the header is missing");
  const std::size_t columns = lines.text() == first_header ? first_columns : all_columns;
  if (columns == all_columns && lines.text() != header())
    throw_at_line(path, 1, "is not the header of a history (" + header() + ")");
  std::vector<HistoryRow> rows;
  while (lines.next())
    if (!parse(lines.fields(), columns, rows.emplace_back()))
      throw_at_line(path, lines.line(), "is not " + std::to_string(columns) + " numbers");
  if (!content.ends_with('\n')) throw_at_line(path, lines.line(), "the line does not end");
  return rows;
}

}  // namespace talus
