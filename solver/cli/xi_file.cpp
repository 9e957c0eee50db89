#include "cli/xi_file.hpp"

#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "io/files.hpp"
#include "math/error.hpp"

namespace talus::cli {
namespace {

constexpr std::size_t max_bytes = std::size_t{64} << 20;

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view space = " \t\r\"";
  const std::size_t first = text.find_first_not_of(space);
  return first == std::string_view::npos ? std::string_view{}
                                         : text.substr(first, text.find_last_not_of(space) - first + 1);
}

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t at = 0;;) {
    const std::size_t comma = line.find(',', at);
    cells.push_back(trimmed(line.substr(at, comma - at)));
    if (comma == std::string_view::npos) return cells;
    at = comma + 1;
  }
}

std::optional<double> to_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

// A header names columns; a line with a digit first in some cell is data, right or wrong.
bool is_header(const std::vector<std::string_view>& cells) {
  for (const std::string_view cell : cells) {
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
  bool first = true;
  int number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = trimmed(std::string_view(text).substr(at, end - at));
    at = end + 1;
    ++number;
    if (line.empty() || line.starts_with('#')) continue;
    const std::vector<std::string_view> cells = cells_of(line);
    if (std::exchange(first, false) && is_header(cells)) {
      for (std::size_t i = 0; i < cells.size(); ++i) {
        if (cells[i] == "xi") column = i;
      }
      continue;
    }
    const std::string place = path.string() + ":" + std::to_string(number);
    const std::size_t index = column.value_or(cells.size() - 1);
    if (index >= cells.size()) throw ConfigError(place, "has no column xi");
    const std::optional<double> value = to_number(cells[index]);
    if (!value) throw ConfigError(place, "\"" + std::string(cells[index]) + "\" is not a finite number");
    xi.push_back(*value);
  }
  if (xi.empty()) throw ConfigError(path.string(), "holds no number");
  return xi;
}

}  // namespace talus::cli
