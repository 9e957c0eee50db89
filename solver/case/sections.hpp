#pragma once
// The sections of a case file, each JSON object -> struct.

#include <filesystem>
#include <vector>

#include "case/case.hpp"
#include "case/vertices.hpp"

namespace talus {

/// Degrees of a file -> radians.
double radians(double degrees);

// read_physics.cpp
/// `base`: the resolved default material that this one overrides in part, or null for the default itself.
Material read_material(ObjectReader& in, const Json* base);
Rheology read_rheology(ObjectReader in, Json& resolved);
Numerics read_numerics(ObjectReader in, Json& resolved);
Walls read_walls(ObjectReader in, Json& resolved);
TimeControl read_time(ObjectReader in, Json& resolved);

// read_geometry.cpp
/// The slide, and where each of its outlines is written.
struct SlideText {
  std::vector<SlidePart> parts;
  std::vector<Vertices> origins;    ///< of the parts' vertices
  std::vector<Material> materials;  ///< the default one, then those of the outlines, each once
};
/// @param material  the default material and its resolved form
SlideText read_slide(ObjectReader in, const std::filesystem::path& directory, const Material& material,
                     const Json& material_json, Json& resolved);
/// @param slide  for the default height of the end walls; @param dx  particle spacing [m]
/// @param bed    where the bed's vertices are written
Terrain read_terrain(ObjectReader in, const std::filesystem::path& directory, const SlideText& slide, double dx,
                     Vertices& bed, Json& resolved);

// read_statistics.cpp
FieldSpec read_field(ObjectReader in, Json& resolved);
StudySpec read_study(ObjectReader in, Json& resolved);

}  // namespace talus
