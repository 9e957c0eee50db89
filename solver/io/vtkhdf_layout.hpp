#pragma once
// What stands where in a VTKHDF file: shared by writer, reader and sidecar.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "io/hdf5.hpp"
#include "io/result_json.hpp"
#include "math/angle.hpp"
#include "simulation/frame.hpp"

namespace talus::vtkhdf {

/// An array that changes with time: how the numbers of particle i come out of a frame and go back into it.
struct Field {
  const char* path;
  const char* unit;  ///< as in the keys of a case; "1": none
  int components;
  void (*get)(const Frame& frame, std::size_t i, float* to);
  void (*set)(Frame& frame, std::size_t i, const float* from);

  /// The name that viewers show: the last part of the path.
  std::string name() const { return std::string(path).substr(std::string_view(path).rfind('/') + 1); }
};

template <std::vector<Vec2> Frame::*member>
constexpr Field vector_field(const char* path, const char* unit) {
  return {path, unit, 3,
          [](const Frame& f, std::size_t i, float* to) {
            to[0] = static_cast<float>((f.*member)[i].x);
            to[1] = static_cast<float>((f.*member)[i].y);
            to[2] = 0.0f;
          },
          [](Frame& f, std::size_t i, const float* from) {
            (f.*member)[i] = {from[0], from[1]};
          }};
}

template <std::vector<double> Frame::*member>
constexpr Field scalar_field(const char* path, const char* unit) {
  return {path, unit, 1, [](const Frame& f, std::size_t i, float* to) { *to = static_cast<float>((f.*member)[i]); },
          [](Frame& f, std::size_t i, const float* from) { (f.*member)[i] = *from; }};
}

inline constexpr std::array<Field, 8> fields = {{
    vector_field<&Frame::position>("VTKHDF/Points", "m"),
    vector_field<&Frame::velocity>("VTKHDF/PointData/velocity", "m/s"),
    vector_field<&Frame::displacement>("VTKHDF/PointData/displacement", "m"),
    scalar_field<&Frame::density>("VTKHDF/PointData/density", "kg/m3"),
    scalar_field<&Frame::pressure>("VTKHDF/PointData/pressure", "Pa"),
    {"VTKHDF/PointData/friction_angle_deg", "deg", 1,
     [](const Frame& f, std::size_t i, float* to) { *to = static_cast<float>(friction_angle_deg(f.tan_phi[i])); },
     [](Frame& f, std::size_t i, const float* from) { f.tan_phi[i] = std::tan(radians(*from)); }},
    scalar_field<&Frame::shear_rate>("VTKHDF/PointData/shear_rate", "1/s"),
    // VTK's order of a symmetric tensor: XX YY ZZ XY YZ XZ.
    {"VTKHDF/PointData/stress", "Pa", 6,
     [](const Frame& f, std::size_t i, float* to) {
       for (int k = 0; k < 4; ++k) to[k] = static_cast<float>(f.stress[i][k]);
       to[4] = to[5] = 0.0f;
     },
     [](Frame& f, std::size_t i, const float* from) {
       for (int k = 0; k < 4; ++k) f.stress[i][k] = from[k];
     }},
}};

inline constexpr const Field& points = fields[0];

/// Arrays that a file has where its first frame has them: properties that vary within a material.
struct OptionalField {
  Field field;
  std::vector<double> Frame::*array;
};
inline constexpr std::array<OptionalField, 2> optional_fields = {
    {{scalar_field<&Frame::cohesion>("VTKHDF/PointData/cohesion_Pa", "Pa"), &Frame::cohesion},
     {scalar_field<&Frame::viscosity>("VTKHDF/PointData/viscosity_Pa_s", "Pa s"), &Frame::viscosity}}};

/// The arrays that change with time, of a frame or of a file: all of `fields`, then those of optional_fields that are
/// there.
std::vector<Field> fields_of(const Frame& frame);
std::vector<Field> fields_of(hid_t root);

/// The arrays of a frame, all of one length.
template <class F>
auto arrays_of(F& f) {
  return std::tie(f.position, f.displacement, f.velocity, f.density, f.pressure, f.tan_phi, f.shear_rate, f.stress);
}

/// Arrays that never change, stored once in VTKHDF/PointData: 1 for walls; the particle's number.
inline constexpr std::array<const char*, 2> constant_fields = {"is_wall", "id"};

inline constexpr std::size_t max_chunk = 65536;  ///< rows compressed together

/// Attributes of VTKHDF: Terrain::origin [m]; absent where both are 0. With them the points are of double precision:
/// they are in the coordinates of the case, as in every file.
inline constexpr std::array<const char*, 2> origin_attributes{"origin_x_m", "origin_y_m"};

/// Name of the attribute with the unit of an array; xarray and the CF conventions know it.
inline constexpr const char* units_attribute = "units";
/// Names of the attributes of the group talus: which run the snapshots are of. A median run has no realization, and
/// only a replicate of the noise floor has a perturbation.
inline constexpr const char* title_attribute = "title";
inline constexpr const char* version_attribute = "version";
inline constexpr const char* case_hash_attribute = "case_hash";
inline constexpr const char* seed_attribute = "seed";
inline constexpr const char* realization_attribute = "realization";
inline constexpr const char* perturbation_attribute = "perturbation";

/// Writes the attributes of the group talus, which must exist.
void write_provenance(hid_t root, const Provenance& provenance);
/// Writes version, type, and the cells: one vertex for each of n points.
void write_grid(hid_t root, std::size_t n, std::array<std::int64_t, 2> version);
/// Everything of a file of snapshots that does not change with time, and empty lists for what does.
void create_skeleton(hid_t root, const Frame& first);
/// Appends everything of step number `step` but NSteps.
void append_step(hid_t root, const Frame& frame, std::size_t step);
/// Writes NSteps: from now on the file has that many steps.
void commit(hid_t root, std::size_t steps);
/// Cuts all lists to the first `steps` steps of n particles.
void truncate_steps(hid_t root, std::size_t steps, std::size_t n);

/// The sidecar, XDMF for viewers that cannot read VTKHDF (ParaView < 5.12): light data only, hyperslabs into the arrays
/// of the VTKHDF file. Stress comes as the scalars stress_xx, stress_yy, stress_zz, stress_xy, since readers disagree
/// on the order of tensors.
/// @param file       name of the VTKHDF file, which lies beside the document
/// @param particles  points at each step
/// @param times      of the steps [s]
/// @param far        the points are of double precision
/// @param arrays     of the file
std::string xdmf_document(const std::string& file, std::size_t particles, std::span<const double> times, bool far,
                          std::span<const Field> arrays = fields);

}  // namespace talus::vtkhdf
