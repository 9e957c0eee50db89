#include "study/run_file.hpp"

#include "support/error.hpp"
#include "support/json.hpp"

namespace talus {

RunFile read_run_file(const std::filesystem::path& file, std::int64_t index) {
  constexpr std::size_t max_bytes = std::size_t{1} << 20;
  const Json json = read_json(file, max_bytes);
  try {
    RunFile run;
    Record& record = run.record;
    record.index = index;
    record.done = true;
    for (const Measure& measure : measure_table) record.measures.*measure.member = json.at(measure.key).get<double>();
    record.mean_phi_deg = json.at("field").at("mean_friction_angle_deg").get<double>();
    record.captured_variance = json.at("field").at("captured_variance").get<double>();
    record.steps = json.at("steps").get<std::int64_t>();
    record.wall_clock = json.at("wall_clock_s").get<double>();
    record.digest = json.at("digest").get<std::string>();
    run.interrupted = json.at("ending") == "interrupted";
    const Json& from = json.at("provenance");
    run.seed = from.at("seed").get<std::uint64_t>();
    if (!from.at("realization").is_null()) run.realization = from.at("realization").get<std::int64_t>();
    run.perturbed = !from.at("perturbation").is_null();
    run.case_hash = from.at("case_hash").get<std::string>();
    return run;
  } catch (const Json::exception& e) {
    throw IoError(file.string() + " is not the result of a run: " + e.what());
  }
}

}  // namespace talus
