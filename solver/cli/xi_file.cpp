#include "cli/xi_file.hpp"

#include <algorithm>
#include <cctype>
#include <optional>
#include <string>

#include "support/csv.hpp"
#include "support/error.hpp"
#include "support/files.hpp"
#include "support/text.hpp"

namespace talus::cli {
namespace {

constexpr std::size_t max_bytes = std::size_t{64} << 20;

// A header names columns; a line with a digit first in some cell is data, right or wrong.
bool is_header(const std::vector<std::string>& cells) {
  for (const std::string& cell : cells) {
    if (cell.empty() || std::isalpha(static_cast<unsigned char>(cell.front())) == 0) return false;
    if (cell == "nan" || cell == "inf" || cell == "NaN" || cell == "Infinity") return false;
  }
  return true;
}

}  // namespace

std::vector<double> read_xi(const std::filesystem::path& path) {
  const std::string text = read_file(path, max_bytes);
  std::vector<double> xi;
  std::optional<std::size_t> column;  // unset: the last one
  CsvRows rows(text, CsvStyle::by_hand);
  for (bool first = true; rows.next(); first = false) {
    const std::vector<std::string>& cells = rows.fields();
    if (first && is_header(cells)) {
      const auto at = std::find(cells.begin(), cells.end(), "xi");
      if (at != cells.end()) column = static_cast<std::size_t>(at - cells.begin());
      continue;
    }
    const std::string place = path.string() + ":" + std::to_string(rows.line());
    const std::size_t index = column.value_or(cells.size() - 1);
    if (index >= cells.size()) throw ConfigError(place, "has no column xi");
    const std::optional<double> value = to_number(cells[index]);
    if (!value) throw ConfigError(place, in_quotes(cells[index]) + " is not a finite number");
    xi.push_back(*value);
  }
  if (xi.empty()) throw ConfigError(path.string(), "holds no number");
  return xi;
}

}  // namespace talus::cli
