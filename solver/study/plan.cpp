#include "study/plan.hpp"

#include <algorithm>
#include <cstdint>

#include "support/files.hpp"
#include "support/json.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

namespace fs = std::filesystem;

constexpr const char* plan_name = "plan.json";
constexpr const char* sampling_names[] = {"monte_carlo", "latin_hypercube"};

Json targets_json(const std::vector<TargetName>& targets) {
  Json all = Json::array();
  for (const TargetName& target : targets) all.push_back({{"name", target.name}, {"kind", word(target.kind)}});
  return all;
}

/// Plans of earlier versions, and those without targets, have none.
std::vector<TargetName> targets_of(const Json& plan) {
  std::vector<TargetName> targets;
  for (const Json& target : plan.value("targets", Json::array())) {
    const auto kind = std::ranges::find(target_kind_words, target.at("kind").get<std::string>());
    if (kind == target_kind_words.end()) throw IoError("a target is of an unknown kind");
    targets.push_back({target.at("name"), static_cast<TargetKind>(kind - target_kind_words.begin())});
  }
  return targets;
}

/// A threshold in a plan: its key and its member.
constexpr std::pair<const char*, std::optional<double> HazardClass::*> thresholds[] = {
    {"depth_m", &HazardClass::depth},
    {"speed_m_s", &HazardClass::speed},
    {"dynamic_pressure_Pa", &HazardClass::dynamic_pressure}};

Json classes_json(const std::vector<HazardClass>& classes) {
  Json all = Json::array();
  for (const HazardClass& one : classes) {
    Json& json = all.emplace_back(Json{{"name", one.name}});
    for (const auto& [key, member] : thresholds)
      if (one.*member) json[key] = *(one.*member);
  }
  return all;
}

std::vector<HazardClass> classes_of(const Json& plan) {
  std::vector<HazardClass> classes;
  for (const Json& json : plan.value("hazard_classes", Json::array())) {
    HazardClass& one = classes.emplace_back(HazardClass{.name = json.at("name")});
    for (const auto& [key, member] : thresholds)
      if (json.contains(key)) one.*member = json.at(key).get<double>();
  }
  return classes;
}

Json draws_json(const std::vector<DrawnNumbers>& draws) {
  Json all = Json::array();
  for (const DrawnNumbers& of : draws) all.push_back({{"name", of.name}, {"key", of.key}, {"count", of.count}});
  return all;
}

/// Plans of earlier versions have none.
std::vector<DrawnNumbers> draws_of(const Json& plan) {
  std::vector<DrawnNumbers> draws;
  for (const Json& of : plan.value("draws", Json::array()))
    draws.push_back({.name = of.at("name"), .key = of.at("key"), .count = of.at("count")});
  return draws;
}

Json to_json(const Plan& plan) {
  Json json = {
      {"program", "talus"},
      {"version", plan.version},
      {"title", plan.title},
      {"case_hash", plan.of.hash},
      {"case_hash_without_end", plan.of.hash_without_end},
      {"end_s", plan.of.end},
      {"earlier_case_hashes", plan.earlier},
      {"seed", plan.seed},
      {"realizations", plan.study.realizations},
      {"sampling", sampling_names[static_cast<int>(plan.study.sampling)]},
      {"stratified_modes", plan.study.stratified_modes},
      {"noise_floor_replicates", plan.study.noise_floor_replicates},
      {"stop_when_ci_half_width_below_m", plan.study.stop_half_width ? Json(*plan.study.stop_half_width) : Json()},
      {"max_failed_share", plan.study.max_failed_share},
      {"histogram_edges_m", plan.study.histogram_edges}};
  if (!plan.study.hazard_classes.empty()) json["hazard_classes"] = classes_json(plan.study.hazard_classes);
  if (!plan.targets.empty()) json["targets"] = targets_json(plan.targets);
  if (!plan.draws.empty()) json["draws"] = draws_json(plan.draws);
  return json;
}

Plan from_json(const Json& json) {
  Plan plan{.title = json.at("title"),
            .of = {.hash = json.at("case_hash"),
                   .hash_without_end = json.value("case_hash_without_end", ""),
                   .end = json.value("end_s", 0.0)},
            .version = json.at("version"),
            .seed = json.at("seed"),
            .study = {},
            .targets = targets_of(json),
            .earlier = json.value("earlier_case_hashes", std::vector<std::string>()),
            .draws = draws_of(json)};
  StudySpec& study = plan.study;
  study.realizations = json.at("realizations");
  study.sampling = json.at("sampling") == sampling_names[1] ? Sampling::latin_hypercube : Sampling::monte_carlo;
  study.stratified_modes = json.at("stratified_modes");
  study.noise_floor_replicates = json.at("noise_floor_replicates");
  if (!json.at("stop_when_ci_half_width_below_m").is_null())
    study.stop_half_width = json.at("stop_when_ci_half_width_below_m").get<double>();
  study.max_failed_share = json.at("max_failed_share");
  study.histogram_edges = json.at("histogram_edges_m").get<std::vector<double>>();
  study.hazard_classes = classes_of(json);
  return plan;
}

}  // namespace

std::optional<Plan> find_plan(const fs::path& directory) {
  const fs::path path = directory / plan_name;
  std::error_code error;
  if (!fs::exists(path, error)) return std::nullopt;
  return read_json(path, std::size_t{1} << 24, "a plan of Talus", from_json);
}

void write_plan(const fs::path& directory, const Plan& plan) {
  write_file_atomically(directory / plan_name, with_checksum(to_json(plan)));
}

void check_continues(const Plan& begun, const Plan& asked, const fs::path& directory, bool resume) {
  const std::string elsewhere = "; choose another directory";
  std::string faults;
  const auto refuse = [&](const std::string& why) {
    faults += (faults.empty() ? "" : "\n") + directory.string() + " holds " + why;
  };
  const auto differs = [&](const std::string& what, const std::string& has, const std::string& wants) {
    refuse("a study with " + what + " " + has + ", not " + wants + elsewhere);
  };
  const auto name = [](const Plan& plan) { return std::string(sampling_names[static_cast<int>(plan.study.sampling)]); };
  if (begun.seed != asked.seed) differs("study.seed", std::to_string(begun.seed), std::to_string(asked.seed));
  if (asked.of.extends(begun.of) && !resume)
    refuse("this study up to t = " + to_text(begun.of.end) + " s; --resume continues it to " + to_text(asked.of.end) +
           " s");
  else if (begun.of.extends(asked.of))
    refuse("this study up to t = " + to_text(begun.of.end) + " s, beyond time.end_s = " + to_text(asked.of.end) + " s" +
           elsewhere);
  else if (begun.of.hash != asked.of.hash && !asked.of.extends(begun.of))
    differs("the case hash", begun.of.hash, asked.of.hash + " (another case, or other settings)");
  if (begun.version != asked.version) differs("results of version", begun.version, asked.version);
  if (name(begun) != name(asked)) differs("study.sampling", name(begun), name(asked));
  const std::int64_t has = begun.study.realizations, wants = asked.study.realizations;
  if (has != wants && asked.study.sampling == Sampling::latin_hypercube)
    refuse("a Latin hypercube of " + std::to_string(has) + " realizations, which cannot become one of " +
           std::to_string(wants) + elsewhere);
  else if (wants < has)
    differs("more planned realizations,", std::to_string(has), std::to_string(wants));
  if (!faults.empty()) throw IoError(faults);
}

}  // namespace talus
