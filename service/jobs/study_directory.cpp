#include "jobs/study_directory.hpp"

#include <charconv>

#include "support/files.hpp"
#include "support/text.hpp"

namespace talus::service {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_result_bytes = std::size_t{1} << 20;

std::string stem(const RunKey& run) {
  const std::string digits = std::to_string(run.index);
  return run.floor ? digits : std::string(digits.size() < 6 ? 6 - digits.size() : 0, '0') + digits;
}

}  // namespace

fs::path StudyDirectory::result(const RunKey& run) const {
  return root / (run.floor ? "floor" : "runs") / (stem(run) + ".json");
}
fs::path StudyDirectory::failure(const RunKey& run) const {
  return root / (run.floor ? "floor" : "runs") / (stem(run) + ".failed.json");
}
fs::path StudyDirectory::work(const RunKey& run) const {
  return root / "work" / ((run.floor ? "floor-" : "") + stem(run));
}
fs::path StudyDirectory::log(const RunKey& run) const { return work(run).concat(".log"); }

std::optional<RunResult> read_result(const fs::path& file, const RunKey& run, std::int64_t seed,
                                     const std::string& case_hash) {
  const std::optional<std::string> text = find_file(file, max_result_bytes);
  if (!text) return std::nullopt;
  try {
    const Json json = Json::parse(*text);
    const Json& of = json.at("provenance");
    const bool same = of.at("seed") == seed && of.at("realization") == (run.floor ? 0 : run.index) &&
                      of.at("case_hash") == case_hash && of.at("perturbation").is_null() == !run.floor;
    if (!same || json.at("ending") == "interrupted") return std::nullopt;
    RunResult result;
    for (const Measure& measure : measure_table) result.measures.*measure.member = json.at(measure.key).get<double>();
    result.mean_friction_angle_deg = json.at("field").at("mean_friction_angle_deg").get<double>();
    result.captured_variance = json.at("field").at("captured_variance").get<double>();
    result.steps = json.at("steps").get<std::int64_t>();
    result.wall_clock = json.at("wall_clock_s").get<double>();
    result.digest = json.at("digest").get<std::string>();
    return result;
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

void write_failure(const StudyDirectory& study, const RunKey& run, const RunFailure& failure, std::int64_t attempts,
                   const std::string& rerun) {
  const Json json = {{"job", (run.floor ? "noise-floor replicate " : "realization ") + std::to_string(run.index)},
                     {"reason", failure.reason},
                     {"exit_code", failure.exit_code ? Json(*failure.exit_code) : Json()},
                     {"signal", failure.signal ? Json(*failure.signal) : Json()},
                     {"attempts", attempts},
                     {"log_tail", failure.log_tail},
                     {"rerun", rerun}};
  write_file_atomically(study.failure(run), json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

std::string perturbation(std::int64_t k) { return to_text(static_cast<double>(k) / 1e6); }

std::string replay_command(const RunKey& run, std::int64_t seed) {
  return "talus run case.resolved.json --realization " + std::to_string(run.floor ? 0 : run.index) + " --seed " +
         std::to_string(seed) + (run.floor ? " --perturbation " + perturbation(run.index) : "") + " --out DIR";
}

}  // namespace talus::service
