#include "io/target_history.hpp"

#include <algorithm>
#include <charconv>
#include <string>
#include <string_view>

#include "support/csv.hpp"
#include "support/error.hpp"
#include "support/files.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view target_header =
    "time_s,step,target,depth_m,speed_m_s,dynamic_pressure_Pa,horizontal_force_N_m,downward_force_N_m,"
    "overturning_moment_Nm_m,horizontal_impulse_Ns_m,downward_impulse_Ns_m,overturning_impulse_Nms_m";
constexpr std::size_t columns = 12, first_of_impulse = 9;

std::string numbers_of(const WallLoad& load) {
  return "," + to_text(load.force.x) + "," + to_text(load.force.y) + "," + to_text(load.moment);
}

/// @param before  the row before of the same target; null: there is none
std::string line_of(const TargetRow& row, const Target& target, const TargetRow* before) {
  std::string line = to_text(row.time) + "," + std::to_string(row.step) + "," + csv_quoted(target.of.name) + "," +
                     to_text(row.flow.depth) + "," + to_text(row.flow.speed) + "," + to_text(row.flow.dynamic_pressure);
  if (!target.structure) return line + ",,,,,,\n";
  WallLoad mean;
  if (before != nullptr && row.time > before->time) {
    WallLoad gained = row.impulse;
    gained += -1.0 * before->impulse;
    mean = (1.0 / (row.time - before->time)) * gained;
  }
  return line + numbers_of(mean) + numbers_of(row.impulse) + "\n";
}

bool parse(const std::vector<std::string>& fields, std::span<const Target> targets, TargetRow& row) {
  if (fields.size() != columns) return false;
  const auto number = [&](std::size_t i, auto& value) {
    const char* end = fields[i].data() + fields[i].size();
    const auto [stop, error] = std::from_chars(fields[i].data(), end, value);
    return error == std::errc() && stop == end;
  };
  const auto target = std::ranges::find(targets, fields[2], [](const Target& t) { return t.of.name; });
  if (target == targets.end()) return false;
  row.target = static_cast<std::size_t>(target - targets.begin());
  const bool flow = number(0, row.time) && number(1, row.step) && number(3, row.flow.depth) &&
                    number(4, row.flow.speed) && number(5, row.flow.dynamic_pressure);
  if (!flow || !target->structure) return flow;
  return number(first_of_impulse, row.impulse.force.x) && number(first_of_impulse + 1, row.impulse.force.y) &&
         number(first_of_impulse + 2, row.impulse.moment);
}

}  // namespace

void write_target_history(const fs::path& path, std::span<const Target> targets, std::span<const TargetRow> rows) {
  std::string text = std::string(target_header) + "\n";
  std::vector<const TargetRow*> before(targets.size(), nullptr);
  for (const TargetRow& row : rows) {
    text += line_of(row, targets[row.target], before[row.target]);
    before[row.target] = &row;
  }
  write_file_atomically(path, text);
}

std::vector<TargetRow> read_target_history(const fs::path& path, std::span<const Target> targets) {
  constexpr std::size_t max_bytes = std::size_t{1} << 30;
  const std::string content = read_file(path, max_bytes);
  CsvRows lines(content);
  if (!lines.next() || lines.text() != target_header)
    throw_at_line(path, 1, "is not the header of a history of targets (" + std::string(target_header) + ")");
  std::vector<TargetRow> rows;
  while (lines.next())
    if (!parse(lines.fields(), targets, rows.emplace_back()))
      throw_at_line(path, lines.line(), "is not " + std::to_string(columns) + " fields with a target of the case");
  if (!content.ends_with('\n')) throw_at_line(path, lines.line(), "the line does not end");
  return rows;
}

}  // namespace talus
