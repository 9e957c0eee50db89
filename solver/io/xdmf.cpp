#include "io/vtkhdf_layout.hpp"
#include "support/text.hpp"

namespace talus::vtkhdf {
namespace {

/// Columns first .. first + count - 1 of `rows` rows of an array in the file.
struct Slab {
  std::string path;
  const char* number;      ///< XDMF's name of the type
  std::size_t array_rows;  ///< of the whole array
  int array_columns;
  std::size_t first_row;
  std::size_t rows;
  int first_column;
  int columns;
};

std::string item(const std::string& file, const Slab& s) {
  const bool table = s.array_columns > 1;
  const auto numbers = [table](std::size_t a, int b) {
    return table ? std::to_string(a) + " " + std::to_string(b) : std::to_string(a);
  };
  return "<DataItem ItemType=\"HyperSlab\" Dimensions=\"" +
         (s.columns > 1 ? numbers(s.rows, s.columns) : std::to_string(s.rows)) + "\"><DataItem Dimensions=\"3 " +
         (table ? "2" : "1") + "\" Format=\"XML\" NumberType=\"Int\">" + numbers(s.first_row, s.first_column) + " " +
         numbers(1, 1) + " " + numbers(s.rows, s.columns) + "</DataItem><DataItem Dimensions=\"" +
         numbers(s.array_rows, s.array_columns) + "\" NumberType=\"" + s.number + "\" Precision=\"4\" Format=\"HDF\">" +
         file + ":" + s.path + "</DataItem></DataItem>";
}

std::string attribute(const std::string& name, bool vector, const std::string& data) {
  return "<Attribute Name=\"" + name + "\" AttributeType=\"" + (vector ? "Vector" : "Scalar") + "\" Center=\"Node\">" +
         data + "</Attribute>\n";
}

}  // namespace

std::string xdmf_document(const std::string& file, std::size_t n, std::span<const double> times) {
  const std::size_t rows = n * times.size();
  std::string text =
      "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\"><Domain><Grid Name=\"snapshots\" GridType=\"Collection\" "
      "CollectionType=\"Temporal\">\n";
  for (std::size_t k = 0; k < times.size(); ++k) {
    const auto whole = [&](const Field& f) {
      return item(file, {"/" + std::string(f.path), "Float", rows, f.components, k * n, n, 0, f.components});
    };
    text += "<Grid Name=\"step" + std::to_string(k) + "\" GridType=\"Uniform\"><Time Value=\"" + to_text(times[k]) +
            "\"/><Topology TopologyType=\"Polyvertex\" NumberOfElements=\"" + std::to_string(n) +
            "\" NodesPerElement=\"1\"/>\n" + "<Geometry GeometryType=\"XYZ\">" + whole(fields[0]) + "</Geometry>\n";
    for (const Field& f : std::span(fields).subspan(1))
      if (f.components <= 3) text += attribute(f.name(), f.components == 3, whole(f));
    const std::string point_data = "/VTKHDF/PointData/";
    const char* const components[] = {"stress_xx", "stress_yy", "stress_zz", "stress_xy"};
    for (int c = 0; c < 4; ++c)
      text += attribute(components[c], false, item(file, {point_data + "stress", "Float", rows, 6, k * n, n, c, 1}));
    for (const char* name : constant_fields)
      text += attribute(name, false, item(file, {point_data + name, "Int", n, 1, 0, n, 0, 1}));
    text += "</Grid>\n";
  }
  return text + "</Grid></Domain></Xdmf>\n";
}

}  // namespace talus::vtkhdf
