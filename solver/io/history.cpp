#include "io/history.hpp"

#include <charconv>
#include <string_view>

#include "io/files.hpp"
#include "math/error.hpp"

namespace talus {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view header = "time_s,step,front_m,centre_of_mass_x_m,kinetic_energy_J_per_m,max_speed_m_s";

/// Takes the number before the next comma, or before the end of the line, off the front of `line`.
template <class T>
bool take(std::string_view& line, T& value, bool last = false) {
  const std::size_t end = last ? line.size() : line.find(',');
  if (end == std::string_view::npos) return false;
  const auto [stop, error] = std::from_chars(line.data(), line.data() + end, value);
  if (error != std::errc() || stop != line.data() + end) return false;
  line.remove_prefix(last ? end : end + 1);
  return true;
}

bool parse(std::string_view line, HistoryRow& row) {
  return take(line, row.time) && take(line, row.step) && take(line, row.front) && take(line, row.centre_of_mass_x) &&
         take(line, row.kinetic_energy) && take(line, row.max_speed, true);
}

[[noreturn]] void bad_line(const fs::path& path, std::size_t line, const std::string& what) {
  throw IoError(path.string() + ":" + std::to_string(line) + ": " + what);
}

}  // namespace

std::string format_number(double value) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

void write_history(const fs::path& path, std::span<const HistoryRow> rows) {
  std::string text = std::string(header) + "\n";
  for (const HistoryRow& row : rows)
    text += format_number(row.time) + "," + std::to_string(row.step) + "," + format_number(row.front) + "," +
            format_number(row.centre_of_mass_x) + "," + format_number(row.kinetic_energy) + "," +
            format_number(row.max_speed) + "\n";
  write_file_atomically(path, text);
}

std::vector<HistoryRow> read_history(const fs::path& path) {
  constexpr std::size_t max_bytes = std::size_t{1} << 30;
  const std::string content = read_file(path, max_bytes);
  std::string_view rest = content;
  std::vector<HistoryRow> rows;
  for (std::size_t number = 1; !rest.empty(); ++number) {
    const std::size_t end = rest.find('\n');
    if (end == std::string_view::npos) bad_line(path, number, "the line does not end");
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end + 1);
    if (number == 1) {
      if (line != header) bad_line(path, 1, "is not the header of a history (" + std::string(header) + ")");
    } else if (!parse(line, rows.emplace_back())) {
      bad_line(path, number, "is not six numbers");
    }
  }
  if (content.empty()) bad_line(path, 1, "the header is missing");
  return rows;
}

}  // namespace talus
