#include "case/vertices.hpp"

#include "support/csv.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

/// A coordinate of a CSV file, or nothing and a fault.
std::optional<double> read_coordinate(const std::string& field, const std::string& location, Faults& faults) {
  const std::optional<double> x = to_number(field);
  if (x && coordinate.allows(*x)) return *x + 0.0;  // -0 becomes 0
  if (x)
    faults.add(location, shorten(field) + " is out of range; " + coordinate.describe());
  else
    faults.add(location, in_quotes(field) + " is not a number" +
                             (field.find(',') == std::string::npos ? "" : "; write a decimal point"));
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

/// The text of a CSV beside the case; a name with a directory is refused before a file is opened.
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

std::string Vertices::location(std::size_t k) const {
  return lines.empty() ? pointer_to(source, k) : source + ":" + std::to_string(lines[k]);
}

Vertices read_csv(std::string_view text, const std::string& name, Faults& faults) {
  Vertices out{{}, name};
  CsvRows rows(text, CsvStyle::by_hand);
  for (bool first = true; rows.next() && out.points.size() <= most_vertices; first = false) {
    const std::vector<std::string>& fields = rows.fields();
    if (first && fields.size() == 2 && !to_number(fields[0]) && !to_number(fields[1])) continue;  // the header
    const std::string location = name + ":" + std::to_string(rows.line());
    if (fields.size() != 2) {
      faults.add(location, "has " + std::to_string(fields.size()) + " columns, expected 2: x, y in metres");
      continue;
    }
    const auto x = read_coordinate(fields[0], location, faults);
    const auto y = x ? read_coordinate(fields[1], location, faults) : std::nullopt;
    if (!y) continue;
    out.points.push_back({*x, *y});
    out.lines.push_back(rows.line());
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

std::string to_text(Vec2 p) { return "(" + to_text(p.x) + ", " + to_text(p.y) + ")"; }

Json to_json(const std::vector<Vec2>& points) {
  Json list = Json::array();
  for (const Vec2& p : points) list.push_back({p.x, p.y});
  return list;
}

}  // namespace talus
