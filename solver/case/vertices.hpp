#pragma once
// Polylines of a case: inline in the JSON or in a CSV file beside it.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "case/reader.hpp"
#include "math/vec2.hpp"

namespace talus {

inline constexpr Quantity coordinate{"m", -1e8, 1e8};  ///< range of every x and y of a case: any national grid
constexpr double largest_extent = 2e6;                 ///< of bed and slide together along x and along y [m]

/// Most vertices of one polyline.
constexpr std::size_t most_vertices = 20'000;

/// A polyline and where each of its vertices is written.
struct Vertices {
  std::vector<Vec2> points;     ///< [m]
  std::string source;           ///< JSON pointer of the list, or name of the CSV file
  std::vector<int> lines = {};  ///< CSV only: line of each vertex, counted from 1
  std::string form = {};        ///< CSV only: columns, separator and decimals as they were read

  bool empty() const { return points.empty(); }
  /// "/terrain/bed_m/3", or "bed.csv:5"
  std::string location(std::size_t k) const;
};

/// Declares and reads `KEY_m` or `KEY_csv`, whichever is there.
/// @param directory  where CSV files lie
/// @return no vertices when there was a fault or, unless `required`, neither key
Vertices read_vertices(ObjectReader& in, std::string_view key, Size count, const std::filesystem::path& directory,
                       const KeyText& text, bool required = true);

/// The vertices of a table of distances and elevations [m], in any form that read_survey_table takes and any encoding
/// that decoded() tells.
Vertices read_csv(std::string_view text, const std::string& name, Faults& faults);

/// Names of CSV files that are read, as a pattern of JSON Schema.
inline constexpr const char* csv_name_pattern = R"(^[^./\\][^/\\]*(/[^./\\][^/\\]*)*$)";

/// The text of a CSV in the case's directory or below; any other name is refused before a file is opened.
std::optional<std::string> csv_text(const Json& value, const std::string& pointer,
                                    const std::filesystem::path& directory, Faults& faults);

/// "(3, 4.5)"
std::string to_text(Vec2 p);

/// [[x, y], ...] as JSON
Json to_json(const std::vector<Vec2>& points);

}  // namespace talus
