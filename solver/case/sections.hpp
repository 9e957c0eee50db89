#pragma once
// The sections of a case file. Each function declares the keys of one section and reads them into a struct, whose
// values on entry are the defaults.

#include <filesystem>
#include <vector>

#include "case/field_data.hpp"
#include "case/load.hpp"
#include "case/vertices.hpp"

namespace talus {

/// A target as it is written; the ground decides where it stands.
struct TargetInput {
  std::string pointer;  ///< "/targets/0"
  std::string name;
  TargetKind kind = TargetKind::point;
  std::vector<double> x;            ///< point_m, stretch_m or structure/x_m
  std::optional<double> height;     ///< of a structure with x_m [m]
  Vertices outline;                 ///< of a structure; empty: given by x_m and height_m
  std::optional<double> averaging;  ///< [s]
};

/// Where the vertices of bed and outlines are written.
struct SourceLocations {
  Vertices bed;
  std::vector<Vertices> outlines;  ///< of each slide part
  FieldData field_data;            ///< of the random field
  Vertices water;                  ///< of the phreatic line
  std::vector<TargetInput> targets;
  std::vector<std::string> files;  ///< CSV files with the form in which they were read

  void note_file(const Vertices& v) {
    if (!v.form.empty())
      files.push_back(v.source + ": " + v.form + ", " + std::to_string(v.points.size()) + " vertices");
  }
};

/// The whole case.
/// @param directory  where CSV files lie
/// @param origins    returns where the vertices of bed and slide are written
Case read_case(ObjectReader& in, const std::filesystem::path& directory, SourceLocations& origins);

/// @param m  its placement is read already
void read_lattice(ObjectReader& in, Model& m);

/// A material and its friction angles as written, so that a layer which inherits an angle repeats it exactly.
struct MaterialInput : Material {
  double friction_angle_deg = 0.0;
  double gradient_kPa_per_m = 0.0;             ///< of the undrained strength
  double residual_angle_deg = 0.0;             ///< of softening, where it states one
  double high_rate_friction_angle_deg = 90.0;  ///< of mu_i
};

inline constexpr Quantity friction_angle_range{"deg", 0.0, 89.0};  // tan(89 deg) is 57, and grows without bound beyond

// read_strength.cpp
/// Friction angle and cohesion, or an undrained strength; r_u. A layer that states one kind of strength drops what it
/// would have inherited of the other.
void read_strength(ObjectReader& in, MaterialInput& m);
/// Residual strength and how far the soil must shear until it is reached. @param m  its strength is read already
void read_softening(ObjectReader& in, MaterialInput& m);
/// The phreatic line.
void read_water(ObjectReader& in, Water& w, const std::filesystem::path& directory, SourceLocations& origins);

// read_physics.cpp
void read_material(ObjectReader& in, MaterialInput& m);
void read_rheology(ObjectReader& in, Rheology& r);
/// @param yield, fixed_step  of the case; the default of the integrator depends on them
void read_numerics(ObjectReader& in, Numerics& n, Yield yield, bool fixed_step);
void read_walls(ObjectReader& in, Walls& w, Boundary& bed);
void read_time(ObjectReader& in, TimeControl& t);

// read_geometry.cpp
/// The slide and where each of its outlines is written.
struct SlideInput {
  std::vector<SlidePart> parts;
  std::vector<Vertices> origins;    ///< of the parts' vertices
  std::vector<Material> materials;  ///< the default one, then those of the outlines, each once
  bool by_outlines = false;
  Vertices ground, slip;  ///< the surfaces that the slide lies between; empty where it is given by outlines
};
SlideInput read_slide(ObjectReader& in, const std::filesystem::path& directory, const MaterialInput& fallback);
/// @param slide  for the default height of the end walls; @param dx  particle spacing [m]
/// @param origins  returns where the bed's vertices are written
void read_terrain(ObjectReader& in, Terrain& t, const std::filesystem::path& directory, const SlideInput& slide,
                  double dx, SourceLocations& origins);

// read_targets.cpp
void read_target(ObjectReader& in, const std::filesystem::path& directory, TargetInput& target);

// add_targets.cpp
/// Puts the targets on the ground: Model::targets, and a boundary for each structure, with the walls' slip and
/// strength. Faults: a name twice; a place off the terrain, in the ground or on the slide; a structure without extent,
/// thinner than the particles can see, in the air or over another one.
/// @param model  terrain, slide, spacing and walls without faults
void add_targets(Model& model, const SourceLocations& origins, Faults& faults);

// read_properties.cpp
/// random_field.properties and random_field.correlation.
/// @param directory  where CSV files lie
/// @param origins  returns where the data of the properties are written
void read_properties(ObjectReader& in, FieldSpec& spec, const std::filesystem::path& directory,
                     SourceLocations& origins);

// read_statistics.cpp
/// @param dx  particle spacing [m]; the default of cell_average depends on it
/// @param directory  where CSV files lie
/// @param origins  returns where the data are written
void read_field(ObjectReader& in, FieldSpec& spec, double dx, const std::filesystem::path& directory,
                SourceLocations& origins);
void read_study(ObjectReader& in, StudySpec& s);

// local_coordinates.cpp
/// Takes the lower left corner of the slide off the coordinates where it lies more than ten extents of the case from
/// zero, along each axis for itself (Terrain::origin), and rounds what is left to the micrometre. The same case moved
/// then gives the same bits, on any national grid.
void use_local_coordinates(Case& c);

// checks.cpp: whether slide, bed, walls and field fit one another
/// Slide parts apart from one another, above the bed, between its ends; as many particles as allowed.
void check_geometry(const Model& model, const SourceLocations& origins, Faults& faults);
/// Enough wall layers, and what check_field_choices says.
void check_choices(const Case& c, Faults& faults);

// check_random_field.cpp
/// Friction where a field needs it, distributions and correlations that exist, given coefficients as many as it takes.
/// @param c  with a field
void check_field_choices(const Case& c, Faults& faults);
/// Data in the rectangle of the random field that its distributions can meet, a median friction angle that the trend
/// keeps in range.
/// @param c  with a field
void check_field(const Case& c, const SourceLocations& origins, Faults& faults);
/// Undrained materials, which a field of friction leaves out. @param c  with a field
void warn_of_undrained_layers(const Case& c, std::vector<Fault>& warnings);

// check_water.cpp
/// A phreatic line that covers the slide and does not lie above the ground.
void check_water(const Model& model, const SourceLocations& origins, Faults& faults);
/// A phreatic line that no material feels.
void warn_of_unused_water(const Model& model, std::vector<Fault>& warnings);

// check_demand.cpp: numbers within their ranges that together ask for more than any run can do
/// At most 1e9 time steps. @param model  without faults
void check_steps(const Model& model, Faults& faults);
/// Correlation lengths that some number of modes resolves.
void check_modes(const Case& c, Faults& faults);

// checks.cpp, unlikely_values.cpp: warnings
/// Legal input that is often a mistake: an open end within reach, a wall lower than the slide, a coarse time step.
std::vector<Fault> find_warnings(const Case& c);

// trim.cpp
/// Cuts off the outlines what lies in the ground or in an outline before, and leaves out films: stretches thinner than
/// half a particle spacing, with 10 spacings of soil or more. Warns of each cut above 0.1 % of an outline and of each
/// film.
/// @param model  checked, in local coordinates; returns the mass of the films in left_out
/// @throws ConfigError when less than one particle is left, or an outline cannot be cut
void trim_slide(Model& model, const SourceLocations& origins, std::vector<Fault>& warnings);

// unlikely_values.cpp
/// Warnings of values in the allowed range that no soil has, with the unit that was probably meant.
/// @param c  its materials as they are written
void warn_of_unlikely_values(const Case& c, std::vector<Fault>& warnings);

}  // namespace talus
