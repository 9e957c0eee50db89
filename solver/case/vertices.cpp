#include "case/vertices.hpp"

#include <charconv>
#include <cmath>

#include "case/words.hpp"

namespace talus {
namespace {

std::string_view trim(std::string_view s) {
  constexpr std::string_view blanks = " \t\r\"";
  const auto first = s.find_first_not_of(blanks);
  return first == std::string_view::npos ? "" : s.substr(first, s.find_last_not_of(blanks) - first + 1);
}

std::optional<double> to_number(std::string_view s) {
  if (s.starts_with('+')) s.remove_prefix(1);
  double x = 0.0;
  const auto [end, error] = std::from_chars(s.data(), s.data() + s.size(), x);
  return error == std::errc{} && end == s.data() + s.size() ? std::optional(x) : std::nullopt;
}

std::vector<std::string_view> split(std::string_view line) {
  const char separator = line.find(';') != std::string_view::npos    ? ';'
                         : line.find('\t') != std::string_view::npos ? '\t'
                                                                     : ',';
  std::vector<std::string_view> fields;
  for (std::size_t start = 0; start <= line.size();) {
    const std::size_t end = std::min(line.find(separator, start), line.size());
    fields.push_back(trim(line.substr(start, end - start)));
    start = end + 1;
  }
  return fields;
}

/// One line of data, or nothing and a fault.
std::optional<Vec2> read_line(const std::vector<std::string_view>& fields, const std::string& place, Faults& faults) {
  if (fields.size() != 2) {
    faults.add(place, "has " + std::to_string(fields.size()) + " columns, expected 2: x, y in metres");
    return {};
  }
  std::optional<double> xy[2];
  for (int k = 0; k < 2; ++k) {
    const std::string_view field = fields[static_cast<std::size_t>(k)];
    xy[k] = to_number(field);
    const bool decimal_comma = field.find(',') != std::string_view::npos;
    if (!xy[k])
      faults.add(place, in_quotes(field) + " is not a number" + (decimal_comma ? "; write a decimal point" : ""));
    else if (!std::isfinite(*xy[k]) || !coordinate.allows(*xy[k]))
      faults.add(place, shorten(field) + " is out of range; " + coordinate.describe());
    else
      continue;
    return {};
  }
  return Vec2{*xy[0] + 0.0, *xy[1] + 0.0};
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

/// The text of a CSV beside the case; a name that leads elsewhere is refused before any file is touched.
std::optional<std::string> csv_text(const Json& value, const std::string& pointer,
                                    const std::filesystem::path& directory, Faults& faults) {
  const std::string* name = value.get_ptr<const std::string*>();
  if (name == nullptr || name->empty() || name->starts_with('.') || name->find_first_of("/\\") != std::string::npos) {
    faults.add(pointer, quote(value) + " is not the plain name of a CSV file beside the case");
    return {};
  }
  const std::filesystem::path file = directory / *name;
  try {
    return read_text(file);
  } catch (const IoError& e) {
    faults.add(pointer, *name + std::string(e.what()).substr(file.string().size()));
  } catch (const ConfigError& e) {
    faults.add(pointer, e.what());
  }
  return {};
}

void declare_vertices(ObjectReader& in, const std::string& inline_key, const std::string& csv_key, Size count,
                      const KeyText& text) {
  const Json point = {{"type", "array"}, {"minItems", 2}, {"maxItems", 2}, {"items", number_schema(coordinate)}};
  in.declare(inline_key, {{"type", "array"}, {"minItems", count.least}, {"maxItems", count.most}, {"items", point}},
             text,
             "Unit: m; range: each coordinate >= -1e6 and <= 1e6, " + std::to_string(count.least) + " to " +
                 std::to_string(count.most) + " vertices; ");
  in.declare(
      csv_key, {{"type", "string"}, {"minLength", 1}, {"pattern", R"(^[^./\\][^/\\]*$)"}},
      {"The same as a CSV file beside the case, given by its plain name: two columns x, y in metres, separated by "
       "comma, semicolon or tab; one header line, blank lines and # comments are skipped.",
       text.source},
      "");
}

}  // namespace

std::string Vertices::place(std::size_t k) const {
  return lines.empty() ? pointer_to(source, k) : source + ":" + std::to_string(lines[k]);
}

Vertices read_csv(std::string_view text, const std::string& name, Faults& faults) {
  Vertices out{{}, name};
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  bool header_allowed = true;
  int number = 0;
  for (std::size_t start = 0; start < text.size() && out.points.size() <= most_vertices;) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    const std::string_view line = trim(text.substr(start, end - start));
    start = end + 1;
    ++number;
    if (line.empty() || line.starts_with('#')) continue;
    const auto fields = split(line);
    const bool header = header_allowed && fields.size() == 2 && !to_number(fields[0]) && !to_number(fields[1]);
    header_allowed = false;
    if (header) continue;
    if (const auto point = read_line(fields, name + ":" + std::to_string(number), faults)) {
      out.points.push_back(*point);
      out.lines.push_back(number);
    }
  }
  if (out.points.size() > most_vertices)
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
  if (in.faults().size() == before && out.points.size() < count.least)
    in.faults().add(out.source, "has " + std::to_string(out.points.size()) + " vertices, at least " +
                                    std::to_string(count.least) + " are needed");
  return in.faults().size() == before ? out : Vertices{};
}

Json to_json(const std::vector<Vec2>& points) {
  Json list = Json::array();
  for (const Vec2& p : points) list.push_back({p.x, p.y});
  return list;
}

}  // namespace talus
