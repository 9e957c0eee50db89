#include "case/vertices.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <span>

#include "case/survey_table.hpp"
#include "support/csv.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

/// Elevations that stand for "no data" in elevation models and spreadsheets; the largest numbers of single precision
/// and 1e20 are others.
constexpr double no_data_codes[] = {-9999, -99999, -999999, -32767, -32768, 9999, 99999, 999999};
constexpr std::string_view no_data_words[] = {"nan", "na", "n/a", "null", "none", "nodata", "no data", "-", "*"};

bool is_no_data(double elevation) {
  return std::ranges::find(no_data_codes, elevation) != std::end(no_data_codes) || std::abs(elevation) >= 1e20;
}

bool is_no_data(std::string word) {
  for (char& c : word) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return word.empty() || std::ranges::find(no_data_words, word) != std::end(no_data_words);
}

/// Whether elevation k stands alone: more than 1,000 m above or below its neighbours on both sides, and steeper than
/// 2 : 1 towards both. No ground on land does that.
bool is_spike(std::span<const Vec2> line, std::size_t k) {
  if (k == 0 || k + 1 >= line.size()) return false;
  const Vec2 before = line[k] - line[k - 1], after = line[k] - line[k + 1];
  const auto steep = [](Vec2 step) { return std::abs(step.y) > 1000.0 && std::abs(step.y) > 2.0 * std::abs(step.x); };
  return steep(before) && steep(after) && (before.y > 0.0) == (after.y > 0.0);
}

std::string no_data_message(const std::string& value) {
  return "elevation " + value + " stands for no data; remove the vertex or give the elevation";
}

/// Faults of elevations that are none: the first, and how many more.
void check_no_data(const Vertices& v, Faults& faults) {
  std::optional<std::size_t> first;
  std::size_t more = 0;
  for (std::size_t k = 0; k < v.points.size(); ++k) {
    if (!is_no_data(v.points[k].y) && !is_spike(v.points, k)) continue;
    more += first ? 1 : 0;
    first = first.value_or(k);
  }
  if (!first) return;
  const double y = v.points[*first].y;
  const std::string rest =
      more == 0 ? "" : " (and " + std::to_string(more) + (more == 1 ? " more vertex)" : " more vertices)");
  faults.add(v.location(*first), (is_no_data(y) ? no_data_message(to_text(y))
                                                : "elevation " + to_text(y) + " lies more than 1,000 m from both its " +
                                                      "neighbours: no data, or a slip of the unit") +
                                     rest);
}

/// A coordinate of a CSV file, or nothing and a fault.
std::optional<double> read_coordinate(const std::string& cell, bool elevation, int line, LineFaults& found) {
  const std::optional<double> x = to_number(cell);
  if (x && coordinate.allows(*x)) return *x + 0.0;  // -0 becomes 0
  if (elevation && (x ? is_no_data(*x) : is_no_data(cell)))
    found.add("no data", line, no_data_message(in_quotes(cell)));
  else if (x)
    found.add("range", line, shorten(cell) + " is out of range; " + coordinate.describe());
  else
    found.add("number", line, in_quotes(cell) + " is not a number" + (has_station(cell) ? no_stations : ""));
  return {};
}

Vertices read_inline(const Json& value, const std::string& pointer, Faults& faults) {
  Vertices out{{}, pointer};
  if (!value.is_array() || value.size() > most_vertices) {
    faults.add(pointer, value.is_array() ? "has " + std::to_string(value.size()) + " vertices, at most " +
                                               std::to_string(most_vertices) + " are allowed"
                                         : quote(value) + " is not a list of points [x, y] in metres");
    return out;
  }
  for (std::size_t k = 0; k < value.size(); ++k) {
    const Json& point = value[k];
    if (!point.is_array() || point.size() != 2) {
      faults.add(pointer_to(pointer, k), quote(point) + " is not a point [x, y] in metres");
      continue;
    }
    const auto x = read_number(point[0], coordinate, pointer_to(pointer_to(pointer, k), 0), faults);
    const auto y = read_number(point[1], coordinate, pointer_to(pointer_to(pointer, k), 1), faults);
    if (x && y) out.points.push_back({*x, *y});
  }
  return out;
}

/// Whether a name is a relative path that only goes down: names joined by slashes, none of which begins with a dot.
bool goes_down(const std::string& name) {
  if (name.find('\\') != std::string::npos || name.find('\0') != std::string::npos) return false;
  for (std::size_t begin = 0; begin <= name.size();) {
    const std::size_t end = std::min(name.find('/', begin), name.size());
    if (end == begin || name[begin] == '.') return false;
    begin = end + 1;
  }
  return true;
}

/// Whether a file lies in the directory or below it once all links are followed.
bool lies_in(const std::filesystem::path& file, const std::filesystem::path& directory) {
  std::error_code error;
  const auto base = std::filesystem::canonical(directory.empty() ? "." : directory, error);
  const auto target = error ? std::filesystem::path() : std::filesystem::canonical(file, error);
  return error || std::ranges::mismatch(base, target).in1 == base.end();  // reading reports what is missing
}

void declare_vertices(ObjectReader& in, const std::string& inline_key, const std::string& csv_key, Size count,
                      const KeyText& text) {
  const Json point = {{"type", "array"}, {"minItems", 2}, {"maxItems", 2}, {"items", number_schema(coordinate)}};
  in.declare(inline_key, {{"type", "array"}, {"minItems", count.least}, {"maxItems", count.most}, {"items", point}},
             text,
             "Unit: m; range: each coordinate >= -1e8 and <= 1e8, " + std::to_string(count.least) + " to " +
                 std::to_string(count.most) + " vertices; ");
  in.declare(
      csv_key, {{"type", "string"}, {"minLength", 1}, {"pattern", csv_name_pattern}},
      {"The same as a CSV file beside the case or in a directory below it: distance and elevation in metres, separated "
       "by comma, semicolon, tab or blanks. With more than two columns a header must name the two: x, distance, "
       "chainage, station or offset; y, z, elevation or height.",
       text.source},
      "");
}

}  // namespace

std::optional<std::string> csv_text(const Json& value, const std::string& pointer,
                                    const std::filesystem::path& directory, Faults& faults) {
  const std::string* name = value.get_ptr<const std::string*>();
  if (name == nullptr || !goes_down(*name)) {
    faults.add(pointer, quote(value) + " is not the name of a CSV file beside the case or in a directory below it");
    return {};
  }
  const std::filesystem::path file = directory / *name;
  if (!lies_in(file, directory)) {
    faults.add(pointer, quote(value) + " is a link to a file outside the case's directory");
    return {};
  }
  try {
    return read_text(file);
  } catch (const IoError& e) {
    faults.add(pointer, *name + std::string(e.what()).substr(file.string().size()));
  } catch (const ConfigError& e) {
    faults.add(pointer, e.what());
  }
  return {};
}

std::string Vertices::location(std::size_t k) const {
  return lines.empty() ? pointer_to(source, k) : source + ":" + std::to_string(lines[k]);
}

Vertices read_csv(std::string_view text, const std::string& name, Faults& faults) {
  Vertices out{{}, name};
  LineFaults found(name);
  const SurveyTable table = read_survey_table(decoded(text), most_vertices + 1, found);
  out.form = table.form;
  std::size_t repeated = 0;
  for (const SurveyRow& row : table.rows) {
    const auto x = read_coordinate(row.x, false, row.line, found);
    const auto y = x ? read_coordinate(row.y, true, row.line, found) : std::nullopt;
    if (!y) continue;
    if (!out.points.empty() && out.points.back() == Vec2{*x, *y}) {  // a point that was surveyed twice
      ++repeated;
      continue;
    }
    out.points.push_back({*x, *y});
    out.lines.push_back(row.line);
  }
  if (repeated > 0)
    out.form +=
        ", " + std::to_string(repeated) + (repeated == 1 ? " repeated point" : " repeated points") + " left out";
  found.report(faults);
  if (table.rows.size() > most_vertices)
    faults.add(name, "has more than " + std::to_string(most_vertices) + " vertices");
  return out;
}

Vertices read_vertices(ObjectReader& in, std::string_view key, Size count, const std::filesystem::path& directory,
                       const KeyText& text, bool required) {
  const std::string inline_key = std::string(key) + "_m", csv_key = std::string(key) + "_csv";
  declare_vertices(in, inline_key, csv_key, count, text);
  const Json* points = in.find(inline_key);
  const Json* csv = in.find(csv_key);
  if (points != nullptr && csv != nullptr) in.fault(csv_key, "is given beside " + inline_key + "; give one of the two");
  if (points == nullptr && csv == nullptr && required) in.fault(inline_key, "is missing (or " + csv_key + ")");
  if ((points == nullptr) == (csv == nullptr)) return {};
  const std::size_t before = in.faults().size();
  Vertices out{{}, in.pointer(inline_key)};
  if (points != nullptr)
    out = read_inline(*points, out.source, in.faults());
  else if (const auto content = csv_text(*csv, in.pointer(csv_key), directory, in.faults()))
    out = read_csv(*content, csv->get<std::string>(), in.faults());
  if (in.faults().size() == before) check_no_data(out, in.faults());
  if (in.faults().size() == before && out.points.size() < count.least)
    in.faults().add(out.source, "has " + std::to_string(out.points.size()) + " vertices, at least " +
                                    std::to_string(count.least) + " are needed");
  return in.faults().size() == before ? out : Vertices{};
}

std::string to_text(Vec2 p) { return "(" + to_text(p.x) + ", " + to_text(p.y) + ")"; }

Json to_json(const std::vector<Vec2>& points) {
  Json list = Json::array();
  for (const Vec2& p : points) list.push_back({p.x, p.y});
  return list;
}

}  // namespace talus
