#pragma once
// Snapshots for VTK >= 9.3 (ParaView >= 5.12): temporal VTKHDF, an unstructured grid of vertex cells whose topology is
// stored once; https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html#vtkhdf-file-format. Beside it an
// XDMF file for ParaView 5.11 that points into the same arrays.
//
// Arrays at every step of n particles (float32): Points [m], velocity [m/s], displacement [m], each (n, 3); stress (n,
// 6) [Pa; XX YY ZZ XY YZ XZ, positive in tension]; density [kg/m3], pressure [Pa], friction_angle_deg, cohesion
// [Pa], shear_rate [1/s], each (n). Stored once (int32): is_wall, id, each (n). Points of a case
// far from zero (Terrain::origin) are float64, which keeps the micrometre; the attributes origin_x_m and origin_y_m of
// VTKHDF name the origin, which is part of them. The attribute units of each array says its unit; the attributes title,
// version, case_hash, seed and realization of the group talus say which run it is.
// Not thread-safe (HDF5).

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/hdf5.hpp"
#include "io/result_json.hpp"
#include "math/vec2.hpp"
#include "simulation/frame.hpp"

namespace talus {

/// Writes the snapshots of one run in order. A step is valid once it is counted in NSteps, which is written last: a
/// reader of the growing file, or of one left by a killed process, sees complete steps. Disk space
/// for a step is reserved before it is written, so that a full disk leaves the earlier steps readable.
class SnapshotWriter {
 public:
  /// Creates the file atomically, replacing an older one, and its sidecar with the first step.
  /// @param provenance  of the run; without it the file does not say which run it is of
  /// @throws IoError naming the path; std::invalid_argument when the frame's arrays differ in length or are empty
  SnapshotWriter(std::filesystem::path path, const Frame& first,
                 const std::optional<Provenance>& provenance = std::nullopt);

  /// Continues a file of an earlier process: steps later than `time` [s] are dropped, so that the file becomes
  /// identical to that of an uninterrupted run.
  /// @throws IoError naming the path: missing, damaged, or not such a file
  static SnapshotWriter resume(std::filesystem::path path, double time);

  /// Appends a step and flushes it. A frame with the time of the last one is already present and is skipped.
  /// @throws IoError naming the path; std::invalid_argument when the frame is earlier than the last one or has other
  /// particles
  void append(const Frame& frame);

  /// Closes the file. @throws IoError
  void close();

 private:
  SnapshotWriter(std::filesystem::path path, hdf5::Id file);
  void write_sidecar() const;

  std::filesystem::path path_;
  hdf5::Id file_;
  std::vector<double> times_;  ///< of the steps in the file [s]
  std::size_t particles_ = 0;
  bool far_ = false;  ///< the points are of double precision
};

/// Times of the steps of a file [s]. @throws IoError naming the path
std::vector<double> snapshot_times(const std::filesystem::path& path);

/// A step of a file, with float32 precision; the friction angle is converted back to radians.
/// @throws IoError naming the path, also when it has no step `index`
Frame read_frame(const std::filesystem::path& path, std::size_t index);

/// A named array with one value per point.
struct NamedArray {
  std::string name;  ///< with its unit: "friction_angle_deg"
  std::span<const double> values;
};

/// Writes points with arrays as a VTKHDF file of a single time (float64), atomically.
/// @throws IoError naming the path; std::invalid_argument when an array's length is not that of `positions`
void write_points(const std::filesystem::path& path, std::span<const Vec2> positions,
                  std::span<const NamedArray> arrays);

/// Writes the same as CSV: columns x_m, y_m and the arrays' names; numbers read back bit for bit.
/// @throws as write_points
void write_field_csv(const std::filesystem::path& path, std::span<const Vec2> positions,
                     std::span<const NamedArray> arrays);

}  // namespace talus
