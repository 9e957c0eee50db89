#include "case/load.hpp"

#include <cstdint>

#include "case/checks.hpp"
#include "case/overrides.hpp"
#include "case/sections.hpp"

namespace talus {
namespace {

constexpr Names<Placement> placements[] = {{"cells", Placement::cells}, {"nodes", Placement::nodes}};

Material read_default_material(ObjectReader in, Json& resolved) {
  const Material m = read_material(in, nullptr);
  resolved = in.finish();
  return m;
}

/// Every section in turn; `origins` remembers where bed and slide are written.
Case read_case(ObjectReader root, const std::filesystem::path& directory, Origins& origins, Json& resolved) {
  Case c;
  Json section;
  const auto take = [&](const char* key) { root.record(key, std::move(section)); };
  c.title = root.text("title", 1, 200);
  c.description = root.text("description", 0, 10'000, "");
  c.model.dx = root.number("particle_spacing_m", {"m", 0.0, 1000.0, true});
  c.model.placement = root.choice("particle_placement", placements, c.model.placement);
  c.model.max_particles = static_cast<std::size_t>(
      root.integer("max_particles", {"", 1.0, 1e8}, static_cast<std::int64_t>(c.model.max_particles)));
  c.model.g = {0.0, -root.number("gravity_m_s2", {"m/s2", 0.0, 1e4, true}, -c.model.g.y)};
  const Material material = read_default_material(root.object("material", true), section);
  const Json material_json = section;
  take("material");
  SlideText slide = read_slide(root.object("slide", true), directory, material, material_json, section);
  take("slide");
  c.model.terrain = read_terrain(root.object("terrain", true), directory, slide, c.model.dx, origins.bed, section);
  take("terrain");
  c.model.slide = std::move(slide.parts);
  c.model.materials = std::move(slide.materials);
  origins.outlines = std::move(slide.origins);
  c.model.rheology = read_rheology(root.object("rheology"), section);
  take("rheology");
  c.model.numerics = read_numerics(root.object("numerics"), section);
  take("numerics");
  c.model.walls = read_walls(root.object("walls"), section);
  take("walls");
  c.model.time = read_time(root.object("time", true), section);
  take("time");
  if (root.find("random_field") != nullptr) {
    c.field = read_field(root.object("random_field"), section);
    take("random_field");
  }
  c.study = read_study(root.object("study"), section);
  take("study");
  resolved = root.finish();
  return c;
}

LoadedCase load_document(Json document, const std::filesystem::path& directory,
                         std::span<const std::string> overrides) {
  Faults faults;
  const std::vector<Override> applied = apply_overrides(document, overrides, faults);
  LoadedCase out;
  Origins origins;
  out.value = read_case(ObjectReader(document, "", faults), directory, origins, out.resolved);
  const auto sound = [&](std::initializer_list<const char*> pointers) {
    for (const char* p : pointers)
      if (!faults.none_under(p)) return false;
    return true;
  };
  // A CSV fault stands at its file, not under /terrain or /slide: then bed or slide is empty.
  const bool shaped = !out.value.model.terrain.bed.empty() && !out.value.model.slide.empty();
  if (shaped && sound({"/terrain", "/slide", "/particle_spacing_m", "/max_particles", "/walls", "/particle_placement"}))
    check_geometry(out.value.model, origins, faults);
  if (sound({"/walls", "/numerics", "/random_field", "/material", "/slide"})) check_choices(out.value, faults);
  if (!faults.empty()) throw ConfigError(name_origins(faults.all(), applied));
  out.warnings = name_origins(find_doubts(out.value), applied);
  out.hash = case_hash(out.resolved);
  return out;
}

}  // namespace

LoadedCase load_case(const std::filesystem::path& path, std::span<const std::string> overrides) {
  Json document = parse_json(read_text(path), path.filename().string());
  LoadedCase out = load_document(std::move(document), path.parent_path(), overrides);
  out.path = path;
  return out;
}

LoadedCase load_case(const Json& document, const std::filesystem::path& directory,
                     std::span<const std::string> overrides) {
  return load_document(document, directory, overrides);
}

std::string case_hash(const Json& resolved) {
  nlohmann::json deciding = resolved;  // the plain kind sorts its keys
  deciding.erase("title");
  deciding.erase("description");
  if (const auto study = deciding.find("study"); study != deciding.end())
    for (const char* key : {"realizations", "seed", "noise_floor_replicates", "stop_when_ci_half_width_below_m",
                            "max_failed_share", "histogram_edges_m"})
      study->erase(key);
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char c : deciding.dump()) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  constexpr char digits[] = "0123456789abcdef";
  std::string text(16, '0');
  for (std::size_t k = 0; k < 16; ++k) text[15 - k] = digits[(hash >> (4 * k)) & 15U];
  return text;
}

}  // namespace talus
