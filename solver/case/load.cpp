#include "case/load.hpp"

#include <cstdint>

#include "case/field_materials.hpp"
#include "case/overrides.hpp"
#include "case/sections.hpp"
#include "particles/geometry.hpp"
#include "support/digest.hpp"

namespace talus {
namespace {

constexpr Names<Placement> placements[] = {
    {"cells", Placement::cells}, {"whole_cells", Placement::whole_cells}, {"nodes", Placement::nodes}};

}  // namespace

Case read_case(ObjectReader& in, const std::filesystem::path& directory, SourceLocations& origins) {
  Case c;
  Model& m = c.model;
  in.string("title", c.title, {1, 200}, {"One line that names the case."});
  in.string("description", c.description, {0, 10'000}, {"Where the data come from and what they leave out."});
  in.required_number("particle_spacing_m", m.dx, {"m", 0.0, 1000.0, true},
                     {"Spacing dx of the particles at the start; every particle stands for dx by dx of soil.",
                      "thinnest flow / 10 or finer; [Z20] uses 0.1 and 0.2"});
  in.choice(
      "particle_placement", m.placement, placements,
      {"cells: square cells cut at the outlines, a particle of the cut cell's mass at its centroid, so that the mass "
       "is "
       "that of the outlines; whole_cells: particles of equal mass at the centres of cells, none nearer than half a "
       "spacing to the bed; nodes: the same at lattice nodes, outline edges included, with the wall line half a "
       "spacing "
       "behind the bed.",
       "nodes as in [Z20] Fig. 3"});
  in.object(
      "particle_lattice",
      "How the lattice of particle_placement cells lies, mirrored where the slide goes to the left: to measure what "
      "the arrangement of the particles does to a result.",
      Absent::skip, [&](ObjectReader& section) { read_lattice(section, m); });
  if (m.lattice == Lattice{}) in.remove_record("particle_lattice");
  in.integer("max_particles", m.max_particles, {"", 1.0, 1e8},
             {"Refuse to fill more soil and wall particles than this.", "memory; see talus validate"});
  double gravity = -m.g.y;
  in.number("gravity_m_s2", gravity, {"m/s2", 1e-6, 1e4},
            {"Gravity, downwards.", "9.81 at mid latitudes; n g in a centrifuge"});
  m.g = {0.0, -gravity};
  MaterialInput material;
  in.object("material", "The soil: Mohr-Coulomb yield stress, and a Bingham viscosity or mu(I) friction.",
            Absent::fault, [&](ObjectReader& section) { read_material(section, material); });
  SlideInput slide;
  in.object("slide",
            "The soil that moves: outlines, or the ground surface before the slide and the slip surface beneath it.",
            Absent::fault, [&](ObjectReader& section) { slide = read_slide(section, directory, material); });
  in.object("terrain",
            "The rigid ground: a bed, or nothing where the slide is given by surfaces, which are joined to one.",
            Absent::defaults,
            [&](ObjectReader& section) { read_terrain(section, m.terrain, directory, slide, m.dx, origins); });
  for (const Vertices* v : {&slide.ground, &slide.slip}) origins.note_file(*v);
  for (const Vertices& v : slide.origins) origins.note_file(v);
  m.slide = std::move(slide.parts);
  m.materials = std::move(slide.materials);
  origins.outlines = std::move(slide.origins);
  in.object("water",
            "Ground water before the slide, for materials that state no r_u. Without this section they are dry.",
            Absent::skip, [&](ObjectReader& section) { read_water(section, m.water, directory, origins); });
  in.object("rheology", "How the soil yields.", Absent::defaults,
            [&](ObjectReader& section) { read_rheology(section, m.rheology); });
  const Json* time = in.find("time");
  const bool fixed_step = time != nullptr && time->is_object() && time->contains("fixed_step_s");
  in.object("numerics", "How the equations are discretised.", Absent::defaults,
            [&](ObjectReader& section) { read_numerics(section, m.numerics, m.rheology.yield, fixed_step); });
  Boundary& bed = m.boundaries.emplace_back();
  bed.line = ground_line(m.terrain);
  in.object("walls", "How the ground acts on the soil.", Absent::defaults,
            [&](ObjectReader& section) { read_walls(section, m.walls, bed); });
  in.object("time", "When to stop and what to keep.", Absent::fault,
            [&](ObjectReader& section) { read_time(section, m.time); });
  in.objects("targets", {0, 100},
             {"Places that the slide may reach: observed points and stretches, and structures that stand in its way. "
              "Results and studies state for each whether and when the slide arrives, how deep, how fast and with what "
              "load.",
              "user", "none"},
             "One target. Give point_m, stretch_m or structure.",
             [&](ObjectReader& target) { read_target(target, directory, origins.targets.emplace_back()); });
  if (origins.targets.empty()) in.remove_record("targets");
  for (const TargetInput& target : origins.targets) origins.note_file(target.outline);
  in.object(
      "random_field",
      "Random soil. Give one correlation_length_m, or both of x and y, or scales of fluctuation in the same way; and "
      "properties, or the short form of a lognormal tan(phi): log_stdev (and log_mean), or cov_tan_phi (and "
      "mean_tan_phi). Without this section every property is the material's everywhere.",
      Absent::skip, [&](ObjectReader& section) { read_field(section, c.field.emplace(), m.dx, directory, origins); });
  in.object("study", "Monte Carlo over realizations of the random field.", Absent::defaults,
            [&](ObjectReader& section) { read_study(section, c.study); });
  return c;
}

LoadedCase load_case(const std::filesystem::path& path, std::span<const std::string> overrides) {
  LoadedCase out = load_case(parse_json(read_text(path), path.filename().string()), path.parent_path(), overrides);
  out.path = path;
  return out;
}

LoadedCase load_case(Json document, const std::filesystem::path& directory, std::span<const std::string> overrides) {
  Faults faults;
  LoadedCase out;
  std::vector<std::string> texts(overrides.begin(), overrides.end());
  out.warnings = replace_aliases(document, texts);
  const std::vector<Override> applied = apply_overrides(document, texts, faults);
  SourceLocations origins;
  ObjectReader root(document, "", faults);
  out.value = read_case(root, directory, origins);
  out.resolved = root.finish();
  const auto free_of_faults = [&](std::initializer_list<const char*> pointers) {
    for (const char* p : pointers)
      if (!faults.none_under(p)) return false;
    return true;
  };
  const bool shaped = !out.value.model.terrain.bed.empty() && !out.value.model.slide.empty();
  const bool placed = shaped && free_of_faults({"/terrain", "/slide", "/particle_spacing_m", "/walls", "/targets"});
  if (placed) add_targets(out.value.model, origins, faults);
  // A CSV fault stands at its file, not under /terrain or /slide: then bed or slide is empty.
  if (shaped &&
      free_of_faults({"/terrain", "/slide", "/particle_spacing_m", "/max_particles", "/walls", "/particle_placement"}))
    check_geometry(out.value.model, origins, faults);
  if (shaped && free_of_faults({"/terrain", "/slide", "/particle_spacing_m", "/water"}))
    check_water(out.value.model, origins, faults);
  if (free_of_faults({"/walls", "/numerics", "/random_field", "/material", "/slide"})) check_choices(out.value, faults);
  if (shaped && out.value.field && free_of_faults({"/terrain", "/slide", "/material", "/random_field"}))
    check_field(out.value, origins, faults);
  if (faults.empty()) {
    warn_of_unlikely_values(out.value, out.warnings);
    if (out.value.field) use_property_means(out.value.model, *out.value.field);
    check_steps(out.value.model, faults);
    check_modes(out.value, faults);
  }
  if (!faults.empty()) throw ConfigError(name_origins(faults.all(), applied));
  for (Fault& warning : find_warnings(out.value)) out.warnings.push_back(std::move(warning));
  use_local_coordinates(out.value);
  trim_slide(out.value.model, origins, out.warnings);
  out.warnings = name_origins(std::move(out.warnings), applied);
  out.hash = case_hash(out.resolved);
  Json endless = out.resolved;
  endless["time"].erase("end_s");
  if (!out.value.model.time.snapshots_exact) endless["time"].erase("snapshot_times_s");  // else the steps depend on it
  out.hash_without_end = case_hash(endless);
  out.bed_source = origins.bed.source;
  out.files = std::move(origins.files);
  return out;
}

std::string case_hash(const Json& resolved) {
  nlohmann::json deciding = resolved;  // the plain kind sorts its keys
  deciding.erase("title");
  deciding.erase("description");
  if (const auto study = deciding.find("study"); study != deciding.end())
    for (const char* key : {"realizations", "seed", "noise_floor_replicates", "stop_when_ci_half_width_below_m",
                            "max_failed_share", "histogram_edges_m", "hazard_classes"})
      study->erase(key);
  return hex_digits(fnv1a64(deciding.dump()));
}

Plan make_plan(const LoadedCase& loaded, std::uint64_t seed, const std::string& version) {
  const Case& c = loaded.value;
  if (c.study.realizations > 1) {
    const char* same = "every realization would be the same: ";
    if (!c.field) throw ConfigError("/random_field", std::string(same) + "a study needs a random field");
    if (!c.field->random())
      throw ConfigError("/random_field", std::string(same) + "the standard deviation of the field is 0");
    if (!c.field->xi.empty())
      throw ConfigError("/random_field/xi", std::string(same) + "the coefficients are given; remove them to draw");
  }
  if (c.study.sampling == Sampling::latin_hypercube && c.study.stop_half_width)
    throw ConfigError(
        "/study/stop_when_ci_half_width_below_m",
        "a Latin hypercube is one sample of a fixed size and cannot stop early; use monte_carlo or remove this");
  std::vector<TargetName> targets;
  for (const Target& target : c.model.targets) targets.push_back(target.of);
  return {.title = c.title,
          .of = {.hash = loaded.hash, .hash_without_end = loaded.hash_without_end, .end = c.model.time.end},
          .version = version,
          .seed = seed,
          .study = c.study,
          .targets = std::move(targets)};
}

}  // namespace talus
