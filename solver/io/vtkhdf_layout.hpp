#pragma once
// What stands where in a VTKHDF file: shared by writer, reader and sidecar.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "io/hdf5.hpp"
#include "math/angle.hpp"
#include "simulation/frame.hpp"

namespace talus::vtkhdf {

/// An array that changes with time: how the numbers of particle i come out of a frame and go back into it.
struct Field {
  const char* name;
  int components;
  void (*get)(const Frame& frame, std::size_t i, float* to);
  void (*set)(Frame& frame, std::size_t i, const float* from);
};

inline void get_vector(Vec2 v, float* to) {
  to[0] = static_cast<float>(v.x);
  to[1] = static_cast<float>(v.y);
  to[2] = 0.0f;
}

template <std::vector<Vec2> Frame::*member>
constexpr Field vector_field(const char* name) {
  return {name, 3, [](const Frame& f, std::size_t i, float* to) { get_vector((f.*member)[i], to); },
          [](Frame& f, std::size_t i, const float* from) {
            (f.*member)[i] = {from[0], from[1]};
          }};
}

template <std::vector<double> Frame::*member>
constexpr Field scalar_field(const char* name) {
  return {name, 1, [](const Frame& f, std::size_t i, float* to) { *to = static_cast<float>((f.*member)[i]); },
          [](Frame& f, std::size_t i, const float* from) { (f.*member)[i] = *from; }};
}

inline constexpr Field points = vector_field<&Frame::position>("Points");

inline constexpr std::array<Field, 7> fields = {{
    vector_field<&Frame::velocity>("velocity"),
    vector_field<&Frame::displacement>("displacement"),
    scalar_field<&Frame::density>("density"),
    scalar_field<&Frame::pressure>("pressure"),
    {"friction_angle_deg", 1,
     [](const Frame& f, std::size_t i, float* to) { *to = static_cast<float>(degrees(std::atan(f.tan_phi[i]))); },
     [](Frame& f, std::size_t i, const float* from) { f.tan_phi[i] = std::tan(radians(*from)); }},
    scalar_field<&Frame::shear_rate>("shear_rate"),
    // VTK's order of a symmetric tensor: XX YY ZZ XY YZ XZ.
    {"stress", 6,
     [](const Frame& f, std::size_t i, float* to) {
       for (int k = 0; k < 4; ++k) to[k] = static_cast<float>(f.stress[i][k]);
       to[4] = to[5] = 0.0f;
     },
     [](Frame& f, std::size_t i, const float* from) {
       for (int k = 0; k < 4; ++k) f.stress[i][k] = from[k];
     }},
}};

/// Arrays that never change, stored once: 1 for walls; the particle's number.
inline constexpr const char* is_wall = "is_wall";
inline constexpr const char* id = "id";
inline constexpr std::array<const char*, 2> constant_fields = {is_wall, id};

/// Our own group beside VTKHDF; VTK passes it over.
inline constexpr const char* own_group = "talus";

inline constexpr std::size_t max_chunk = 65536;  ///< rows compressed together

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

}  // namespace talus::vtkhdf
