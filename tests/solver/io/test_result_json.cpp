#include <cmath>
#include <cstdlib>
#include <limits>
#include <stdexcept>

#include "io/result_json.hpp"
#include "io_faults.hpp"
#include "math/angle.hpp"
#include "schema_check.hpp"
#include "support/files.hpp"
#include "temporary_directory.hpp"

namespace talus {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;
using test::io_error;
using test::TemporaryDirectory;

constexpr std::size_t megabyte = 1 << 20;

/// Another value for every member.
RunResult sample_result() {
  return {.measures = {.influence_zone = 34.1,
                       .front_connected = 33.2,
                       .front_mass_99 = 32.3,
                       .front_mass_999 = 33.4,
                       .centre_of_mass_x = -0.0,
                       .front_at_thickness = 31.5},
          .front_thickness = 0.6,
          .notes = {"thrown"},
          .lower_bounds = {"influence_zone_m", "centre_of_mass_x_m"},
          .ending = Ending::at_rest,
          .soil = 12700,
          .wall = 4236,
          .steps = 30000,
          .time = 1.0 / 3.0,
          .evaluations = 60000,
          .wall_clock = 12.5,
          .threads = 3,
          .max_speed = 9.75,
          .final_max_speed = 5e-324,
          .penetrated = 1,
          .left_domain = 2,
          .at_rest = true,
          .mass = {.filled = 27901.5, .outline = 27900.25},
          .digest = "0123456789abcdef",
          .backend = "vectorised",
          .simd = "AVX2",
          .field = {.captured_variance = 0.016,
                    .cov = 0.04,
                    .mean_phi = radians(25.0),
                    .terms = 5,
                    .properties = {{.name = "friction", .mean = 0.5, .cov = 0.25, .run_mean = 0.75, .run_cov = 0.125},
                                   {.name = "unit_weight", .mean = 19, .cov = 0.5, .run_mean = 18, .run_cov = 0}}},
          .energy = {.kinetic = 1,
                     .potential = -1024,
                     .compression = 2,
                     .distortion = 4,
                     .friction = 512,
                     .viscosity = 8,
                     .artificial_viscosity = 256,
                     .density_diffusion = 16,
                     .boundaries = 32,
                     .contact = 64,
                     .departed = 128,
                     .stored_at_start = 3},
          .quality = {.verdict = Verdict::invalid,
                      .reasons = {{.check = "compression", .value = 0.06, .limit = 0.05, .message = "6 %"},
                                  {.check = "mach_number",
                                   .verdict = Verdict::invalid,
                                   .value = 1.5,
                                   .limit = 0.5,
                                   .message = "1.5 times"}}},
          .targets = {{.of = {"road", TargetKind::stretch}},
                      {.of = {"house", TargetKind::structure},
                       .arrives = true,
                       .open = true,
                       .arrival = 1.5,
                       .peak_depth = 2.5,
                       .peak_speed = 3.5,
                       .peak_dynamic_pressure = 4.5,
                       .final_depth = 5.5,
                       .peak_horizontal_force = 6.5,
                       .peak_downward_force = 7.5,
                       .peak_overturning_moment = 8.5,
                       .final_horizontal_force = -9.5,
                       .horizontal_impulse = 10.5,
                       .downward_impulse = -11.5}},
          .warnings = {{"/time/end_s", "is long"}}};
}

Provenance sample_provenance() {
  return {.version = "0.1.0",
          .seed = 9007199254740993u,
          .realization = 7,
          .perturbation = 1e-6,
          .case_hash = "fedcba9876543210",
          .case_title = "Geröll \"1\"",
          .compiler = "GNU 12",
          .started_utc = "2025-01-31T12:00:00Z"};
}

/// What the schema objects to; "" when nothing.
std::string schema_faults(const json& document) {
  static const test::SchemaCheck schema("result");
  return schema.complaint(document);
}

json document() { return json::parse(result_json(sample_result(), sample_provenance()).dump()); }

TEST(ResultJson, HasTheKeysOfTheContract) {
  const json d = document();
  EXPECT_EQ(d["influence_zone_m"], 34.1);
  EXPECT_EQ(d["front_connected_m"], 33.2);
  EXPECT_EQ(d["front_mass_99_m"], 32.3);
  EXPECT_EQ(d["front_mass_999_m"], 33.4);
  EXPECT_EQ(d["centre_of_mass_x_m"], -0.0);
  EXPECT_EQ(d["front_at_thickness_m"], 31.5);
  EXPECT_EQ(d["front_thickness_m"], 0.6);
  EXPECT_EQ(d["notes"], (json{"thrown"}));
  EXPECT_EQ(d["particles"], (json{{"soil", 12700}, {"wall", 4236}}));
  EXPECT_EQ(d["steps"], 30000);
  EXPECT_EQ(d["time_s"], 1.0 / 3.0);
  EXPECT_EQ(d["evaluations"], 60000);
  EXPECT_EQ(d["wall_clock_s"], 12.5);
  EXPECT_EQ(d["threads"], 3);
  EXPECT_EQ(d["max_speed_m_s"], 9.75);
  EXPECT_EQ(d["final_max_speed_m_s"], 5e-324);
  EXPECT_EQ(d["penetrated"], 1);
  EXPECT_EQ(d["left_domain"], 2);
  EXPECT_EQ(d["lower_bounds"], (json{"influence_zone_m", "centre_of_mass_x_m"}));
  EXPECT_EQ(d["at_rest"], true);
  EXPECT_EQ(d["ending"], "at_rest");
  EXPECT_EQ(d["mass_kg_m"]["filled"], 27901.5);
  EXPECT_EQ(d["mass_kg_m"]["outline"], 27900.25);
  EXPECT_EQ(d["digest"], "0123456789abcdef");
  EXPECT_EQ(d["backend"], "vectorised");
  EXPECT_EQ(d["simd"], "AVX2");
  EXPECT_EQ(d["field"]["captured_variance"], 0.016);
  EXPECT_EQ(d["field"]["cov_tan_phi"], 0.04);
  EXPECT_NEAR(d["field"]["mean_friction_angle_deg"], 25.0, 1e-13);
  EXPECT_EQ(d["field"]["terms"], 5);
  EXPECT_EQ(d["field"]["properties"],
            (json{{"friction", {{"mean_tan_phi", 0.5}, {"cov", 0.25}, {"run_mean_tan_phi", 0.75}, {"run_cov", 0.125}}},
                  {"unit_weight", {{"mean_kN_m3", 19.0}, {"cov", 0.5}, {"run_mean_kN_m3", 18.0}, {"run_cov", 0.0}}}}));
  EXPECT_EQ(d["quality"]["verdict"], "invalid");
  EXPECT_EQ(d["quality"]["reasons"].size(), 2u);
  EXPECT_EQ(
      d["quality"]["reasons"][1],
      (json{
          {"check", "mach_number"}, {"verdict", "invalid"}, {"value", 1.5}, {"limit", 0.5}, {"message", "1.5 times"}}));
  EXPECT_EQ(d["warnings"], (json{{{"pointer", "/time/end_s"}, {"message", "is long"}}}));
  EXPECT_EQ(d["targets"][0], (json{{"name", "road"},
                                   {"kind", "stretch"},
                                   {"arrives", false},
                                   {"open", false},
                                   {"arrival_s", nullptr},
                                   {"peak_depth_m", 0.0},
                                   {"peak_speed_m_s", 0.0},
                                   {"peak_dynamic_pressure_Pa", 0.0},
                                   {"final_depth_m", 0.0}}));
  EXPECT_EQ(d["targets"][1], (json{{"name", "house"},
                                   {"kind", "structure"},
                                   {"arrives", true},
                                   {"open", true},
                                   {"arrival_s", 1.5},
                                   {"peak_depth_m", 2.5},
                                   {"peak_speed_m_s", 3.5},
                                   {"peak_dynamic_pressure_Pa", 4.5},
                                   {"final_depth_m", 5.5},
                                   {"peak_horizontal_force_N_m", 6.5},
                                   {"peak_downward_force_N_m", 7.5},
                                   {"peak_overturning_moment_Nm_m", 8.5},
                                   {"final_horizontal_force_N_m", -9.5},
                                   {"horizontal_impulse_Ns_m", 10.5},
                                   {"downward_impulse_Ns_m", -11.5}}));
  constexpr double created = 1 - 1024 + 2 + 4 + 512 + 8 + 256 + 16 + 32 + 64 + 128 - 3;
  EXPECT_EQ(d["energy"], (json{{"kinetic_J_m", 1},
                               {"potential_J_m", -1024},
                               {"compression_J_m", 2},
                               {"distortion_J_m", 4},
                               {"friction_J_m", 512},
                               {"viscosity_J_m", 8},
                               {"artificial_viscosity_J_m", 256},
                               {"density_diffusion_J_m", 16},
                               {"boundaries_J_m", 32},
                               {"contact_J_m", 64},
                               {"departed_J_m", 128},
                               {"stored_at_start_J_m", 3},
                               {"created_J_m", created},
                               {"created_share", created / 1024},
                               {"numerical_share", 272.0 / 1024}}));
  EXPECT_EQ(d["provenance"]["version"], "0.1.0");
  EXPECT_EQ(d["provenance"]["seed"], 9007199254740993u);
  EXPECT_EQ(d["provenance"]["realization"], 7);
  EXPECT_EQ(d["provenance"]["perturbation"], 1e-6);
  EXPECT_EQ(d["provenance"]["case_hash"], "fedcba9876543210");
  EXPECT_EQ(d["provenance"]["case_title"], "Geröll \"1\"");
  EXPECT_EQ(d["provenance"]["compiler"], "GNU 12");
  EXPECT_EQ(d["provenance"]["started_utc"], "2025-01-31T12:00:00Z");
  EXPECT_EQ(result_json(sample_result(), sample_provenance()).begin().key(), "front_mass_99_m")
      << "what matters most comes first";
}

TEST(ResultJson, ObeysItsSchema) {
  EXPECT_EQ(schema_faults(document()), "");
  Provenance deterministic = sample_provenance();
  deterministic.realization.reset();
  deterministic.perturbation.reset();
  RunResult empty;
  empty.digest = "ffffffffffffffff";
  const ordered_json d = result_json(empty, deterministic);
  EXPECT_TRUE(d["provenance"]["realization"].is_null());
  EXPECT_TRUE(d["energy"]["created_share"].is_null()) << "gravity has done no work";
  EXPECT_TRUE(d["energy"]["numerical_share"].is_null());
  EXPECT_EQ(schema_faults(json::parse(d.dump())), "");
}

TEST(ResultJson, ComesBack) {
  const TemporaryDirectory dir;
  write_file_atomically(dir / "result.json", document().dump());
  const auto [result, provenance] = read_result(dir / "result.json");
  // Written again it is the same text, but for the angle, which went from degrees to radians and back.
  json again = json::parse(result_json(result, provenance).dump());
  EXPECT_NEAR(again["field"]["mean_friction_angle_deg"], 25.0, 1e-13);
  again["field"]["mean_friction_angle_deg"] = document()["field"]["mean_friction_angle_deg"];
  EXPECT_EQ(again.dump(), document().dump());
}

TEST(ResultJson, OfAnEarlierVersionIsReadWithoutWhatCameLater) {
  const TemporaryDirectory dir;
  json earlier = document();
  for (const char* key : {"backend", "simd", "quality", "warnings", "mass_kg_m", "energy", "front_at_thickness_m",
                          "front_thickness_m", "notes", "targets"})
    earlier.erase(key);
  earlier["field"].erase("cov_tan_phi");
  EXPECT_EQ(schema_faults(earlier), "");
  write_file_atomically(dir / "result.json", earlier.dump());
  const RunResult result = read_result(dir / "result.json").first;
  EXPECT_EQ(result.backend, "");
  EXPECT_EQ(result.simd, "");
  EXPECT_EQ(result.mass.outline, 0.0);
  EXPECT_EQ(result.quality.verdict, Verdict::not_assessed);
  EXPECT_TRUE(result.quality.reasons.empty() && result.warnings.empty());
  EXPECT_EQ(result.energy, EnergyBudget());
  EXPECT_TRUE(std::isnan(result.measures.front_at_thickness));
  EXPECT_EQ(result.front_thickness, 0.0);
  EXPECT_TRUE(result.notes.empty());
  EXPECT_EQ(result.digest, earlier["digest"].get<std::string>());
}

TEST(ResultJson, IsReadWithoutAMeasureThatCameLater) {
  const TemporaryDirectory dir;
  json earlier = document();
  earlier.erase("front_mass_999_m");
  write_file_atomically(dir / "result.json", earlier.dump());
  const RunResult result = read_result(dir / "result.json").first;
  EXPECT_TRUE(std::isnan(result.measures.front_mass_999));
  EXPECT_EQ(result.measures.front_mass_99, 32.3);
}

TEST(ResultJson, HasNullForAMeasureThatTheRunHasNot) {
  const TemporaryDirectory dir;
  RunResult result = sample_result();
  result.measures.front_at_thickness = std::nan("");
  const json without = json::parse(result_json(result, sample_provenance()).dump());
  EXPECT_TRUE(without["front_at_thickness_m"].is_null());
  EXPECT_EQ(schema_faults(without), "");
  write_file_atomically(dir / "result.json", without.dump());
  EXPECT_TRUE(std::isnan(read_result(dir / "result.json").first.measures.front_at_thickness));
}

TEST(ResultJson, KeepsTheLargestSeed) {
  const TemporaryDirectory dir;
  Provenance provenance = sample_provenance();
  provenance.seed = 18446744073709551615u;
  write_file_atomically(dir / "result.json", result_json(sample_result(), provenance).dump());
  EXPECT_EQ(read_result(dir / "result.json").second.seed, provenance.seed);
}

TEST(ResultJson, OfEveryEndingComesBack) {
  const TemporaryDirectory dir;
  for (const Ending ending : {Ending::end_time, Ending::at_rest, Ending::interrupted}) {
    RunResult result = sample_result();
    result.ending = ending;
    write_file_atomically(dir / "result.json", result_json(result, sample_provenance()).dump());
    EXPECT_EQ(read_result(dir / "result.json").first.ending, ending);
  }
}

TEST(ResultJson, RefusesNumbersThatJsonHasNoWordFor) {
  RunResult result = sample_result();
  result.measures.front_mass_99 = std::nan("");
  EXPECT_THROW(result_json(result, sample_provenance()), std::domain_error);
  result = sample_result();
  result.field.mean_phi = std::numeric_limits<double>::infinity();
  EXPECT_THROW(result_json(result, sample_provenance()), std::domain_error);
}

/// Every leaf and object of the document by its JSON pointer.
std::vector<std::string> pointers(const json& node, const std::string& pointer = "") {
  std::vector<std::string> all;
  for (const auto& [key, value] : node.items()) {
    all.push_back(pointer + "/" + key);
    if (value.is_object())
      for (const std::string& below : pointers(value, all.back())) all.push_back(below);
  }
  return all;
}

/// The message about a document, which the schema must refuse as well.
std::string refusal(const TemporaryDirectory& dir, const json& bad) {
  EXPECT_NE(schema_faults(bad), "") << bad;
  write_file_atomically(dir / "result.json", bad.dump());
  return io_error([&] { read_result(dir / "result.json"); });
}

TEST(ResultJson, NamesAnyKeyThatIsMissing) {
  const TemporaryDirectory dir;
  for (const std::string& pointer : pointers(document())) {
    const std::string key = pointer.substr(1);
    if (key == "backend" || key == "simd" || key == "quality" || key == "warnings" || key == "mass_kg_m" ||
        key == "energy" || key == "field/cov_tan_phi" || key == "lower_bounds" || key == "front_thickness_m" ||
        key == "notes" || key == "targets" || key == "energy/numerical_share" || key == "field/properties" ||
        key == "field/properties/friction" || key == "field/properties/unit_weight")
      continue;  // came later
    if (const Measure* measure = find_measure(key); measure && measure != measure_table.data()) continue;
    const json::json_pointer place(pointer);
    json bad = document();
    bad[place.parent_pointer()].erase(place.back());
    const std::string message = refusal(dir, bad);
    EXPECT_NE(message.find("result.json: " + pointer + " is missing"), std::string::npos) << message;
  }
}

TEST(ResultJson, NamesAnyKeyThatIsOfTheWrongKind) {
  const TemporaryDirectory dir;
  for (const std::string& pointer : pointers(document())) {
    json bad = document();
    json& value = bad[json::json_pointer(pointer)];
    value = value.is_array() ? json::object() : json::array();
    EXPECT_NE(refusal(dir, bad).find("result.json: " + pointer + " "), std::string::npos);
  }
}

TEST(ResultJson, NamesValuesOutOfRange) {
  const TemporaryDirectory dir;
  const std::pair<const char*, json> cases[] = {{"/steps", -1},
                                                {"/steps", 1.5},
                                                {"/threads", 0},
                                                {"/time_s", -0.5},
                                                {"/wall_clock_s", -1},
                                                {"/particles/soil", -1},
                                                {"/penetrated", -1},
                                                {"/left_domain", -1},
                                                {"/max_speed_m_s", -1.0},
                                                {"/digest", "0123"},
                                                {"/digest", "0123456789ABCDEF"},
                                                {"/ending", "bored"},
                                                {"/quality/verdict", "good"},
                                                {"/targets/0/kind", "house"},
                                                {"/targets/1/arrives", 1},
                                                {"/targets/1/peak_horizontal_force_N_m", nullptr},
                                                {"/quality/reasons", 1},
                                                {"/quality/reasons/0/limit", "1"},
                                                {"/field/captured_variance", -0.1},
                                                {"/provenance/seed", -1},
                                                {"/at_rest", 1},
                                                {"/provenance/realization", -1},
                                                {"/provenance/realization", "7"},
                                                {"/influence_zone_m", "34.1"},
                                                {"/evaluations", nullptr}};
  for (const auto& [pointer, value] : cases) {
    json bad = document();
    bad[json::json_pointer(pointer)] = value;
    const std::string message = refusal(dir, bad);
    EXPECT_NE(message.find(std::string("result.json: ") + pointer + " = " + value.dump()), std::string::npos)
        << message;
  }
}

TEST(ResultJson, RefusesIntegersThatDoNotFit) {
  const TemporaryDirectory dir;
  for (const char* pointer : {"/steps", "/threads"}) {
    json large = document();
    large[json::json_pointer(pointer)] = 18446744073709551615u;
    write_file_atomically(dir / "result.json", large.dump());
    EXPECT_NE(io_error([&] { read_result(dir / "result.json"); }).find(pointer), std::string::npos);
  }
}

TEST(ResultJson, RefusesWhatIsNotJson) {
  const TemporaryDirectory dir;
  for (const char* text : {"", "{", "[]", "null", "{\"influence_zone_m\": 1e999}", "\xff"}) {
    write_file_atomically(dir / "result.json", text);
    EXPECT_NE(io_error([&] { read_result(dir / "result.json"); }).find("result.json"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace talus
