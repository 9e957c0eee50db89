// The keys of targets.

#include "case/sections.hpp"
#include "case/vertices.hpp"

namespace talus {
namespace {

constexpr const char* place_keys[] = {"point_m", "stretch_m", "structure"};

/// Letters, digits, blanks, '-', '_' and any character beyond ASCII: a name heads columns and stands in commands.
bool is_plain(unsigned char c) {
  return c >= 0x80 || (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == ' ' ||
         c == '-' || c == '_';
}

void read_name(ObjectReader& in, TargetInput& target) {
  in.string("name", target.name, {1, 40},
            {"Name of the target: letters, digits, blanks, '-' and '_'. No two targets have the same.", "user"});
  if (!std::ranges::all_of(target.name, is_plain) || target.name.starts_with(' ') || target.name.ends_with(' '))
    in.fault("name", "holds a character that is not allowed: letters, digits, '-', '_', and blanks between them are");
}

/// A list of places that may be absent. @return whether it is given
bool read_places(ObjectReader& in, const char* key, std::vector<double>& values, Size length, const KeyText& text) {
  in.declare(
      key,
      {{"type", "array"}, {"minItems", length.least}, {"maxItems", length.most}, {"items", number_schema(coordinate)}},
      text, "Unit: m; range: " + std::string(text.range_words) + "; ");
  const Json* list = in.find(key);
  if (list == nullptr) return false;
  if (!list->is_array() || list->size() < length.least || list->size() > length.most) {
    const std::string most = std::to_string(length.most);
    in.fault(key, quote(*list) + " is not a list of " +
                      (length.least < length.most ? std::to_string(length.least) + " to " : "") + most +
                      " numbers; each " + coordinate.describe());
    return true;
  }
  for (std::size_t k = 0; k < list->size(); ++k)
    if (const auto x = read_number((*list)[k], coordinate, pointer_to(in.pointer(key), k), in.faults()))
      values.push_back(*x);
  in.record(key, values);
  return true;
}

void read_structure(ObjectReader& in, const std::filesystem::path& directory, TargetInput& target) {
  target.kind = TargetKind::structure;
  const bool by_faces = read_places(in, "x_m", target.x, {2, 2},
                                    {"x of the two faces of an upright structure, [low, high].", "survey", "none",
                                     "low < high, at least walls.layers particle spacings apart"});
  in.optional_number("height_m", target.height, {"m", 0.0, 1e4, true},
                     {"Height of its level top above the highest ground between the faces; with x_m.", "survey",
                      "none: the structure is given by its outline"});
  target.outline = read_vertices(in, "outline", {3, 10'000}, directory,
                                 {"Closed outline of a structure of another shape. What of it lies in the ground is "
                                  "its foundation.",
                                  "survey", "none: the structure is given by x_m and height_m"},
                                 false);
  if (!target.outline.empty()) in.record("outline_m", to_json(target.outline.points));
  in.optional_number("averaging_time_s", target.averaging, {"s", 0.0, 1e6, true},
                     {"Peaks of force and moment are those of means over this time.", "user",
                      "a twentieth of the time of free fall through the fall height of the slide"});
  in.one_form({{{"x_m", "height_m"}, {"averaging_time_s"}},
               {{"outline_m"}, {"averaging_time_s"}},
               {{"outline_csv"}, {"averaging_time_s"}}});
  const bool by_outline = in.find("outline_m") != nullptr || in.find("outline_csv") != nullptr;
  if (by_faces && by_outline) in.fault("x_m", "is given beside an outline; give one of the two");
  if (by_outline && target.height) in.fault("height_m", "is given beside an outline; give one of the two");
  if (!by_faces && !by_outline) in.fault("x_m", "is missing (or outline_m)");
  if (by_faces && !by_outline && !target.height && in.find("height_m") == nullptr) in.fault("height_m", "is missing");
}

}  // namespace

void read_target(ObjectReader& in, const std::filesystem::path& directory, TargetInput& target) {
  target.pointer = in.pointer("");
  target.pointer.pop_back();
  read_name(in, target);
  if (read_places(in, "point_m", target.x, {1, 2},
                  {"One place, [x] or [x, y]. With y above the ground the slide arrives when the flow reaches up to y.",
                   "survey", "none", "on the terrain, not below the ground"}))
    target.kind = TargetKind::point;
  if (read_places(in, "stretch_m", target.x, {2, 2},
                  {"A stretch of the ground, [x1, x2], for example a road. Depth and speed are the largest along it.",
                   "survey", "none", "x1 < x2, on the terrain"}))
    target.kind = TargetKind::stretch;
  in.object("structure",
            "A rigid obstacle, for example a house, a wall or a dam. The soil flows against it, and its load is "
            "measured. Give x_m and height_m, or an outline.",
            Absent::skip, [&](ObjectReader& structure) { read_structure(structure, directory, target); });
  in.one_form({{{"point_m"}, {"name"}}, {{"stretch_m"}, {"name"}}, {{"structure"}, {"name"}}});
  const auto given = std::ranges::count_if(place_keys, [&](const char* key) { return in.find(key) != nullptr; });
  if (given == 0) in.fault("", "has no place; give point_m, stretch_m or structure");
  if (given > 1) in.fault("", "has several places; give one of point_m, stretch_m and structure");
}

}  // namespace talus
