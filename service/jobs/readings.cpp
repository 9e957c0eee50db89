// Results of a job, and pictures that talus makes of one run.

#include <algorithm>

#include "base/json.hpp"
#include "jobs/jobs.hpp"
#include "support/csv.hpp"
#include "support/files.hpp"
#include "support/text.hpp"

namespace talus::service {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr milliseconds histogram_age{1000};  ///< at most, while the job runs
constexpr std::size_t profiles_kept = 16;    ///< of a job
constexpr std::size_t max_bytes = std::size_t{256} << 20;

/// Removes all but the newest requested profiles; those that the study keeps itself stay.
void prune(const fs::path& directory) {
  std::vector<std::pair<fs::file_time_type, fs::path>> files;
  for (const auto& entry : fs::directory_iterator(directory))
    if (run_of_work_name(entry.path().stem().string())) files.emplace_back(entry.last_write_time(), entry.path());
  std::sort(files.rbegin(), files.rend());
  std::error_code ignored;
  for (std::size_t i = profiles_kept; i < files.size(); ++i) fs::remove(files[i].second, ignored);
}

/// @throws Refusal internal unless the command succeeded
void check(const CommandOutput& output, const std::string& what) {
  if (output.ok()) return;
  log_error("talus_failed", {{"exit_code", output.end.exit_code}, {"signal", output.end.signal}, {"said", output.err}});
  throw Refusal(Reason::internal, what + " could not be made");
}

/// Drops the members that are null or contain null: a statistic without a value.
void drop_nulls(Json& object) {
  const auto has_null = [](const Json& value) {
    return value.is_null() || (value.is_array() && std::find(value.begin(), value.end(), Json()) != value.end());
  };
  for (auto at = object.begin(); at != object.end();) at = has_null(*at) ? object.erase(at) : std::next(at);
}

}  // namespace

Json Jobs::distribution(const Job& job, const Measure& quantity, const Bins& bins) {
  const std::string key =
      job.id + "/" + quantity.key + "/" + std::to_string(bins.count) + "/" + Json(bins.edges).dump();
  return distributions_.get(key, job.version, ended(job.state) ? milliseconds(0) : histogram_age, [&] {
    std::optional<Plan> plan = find_plan(data_.job(job.id));
    if (!plan) throw Refusal(Reason::internal, "the plan of the job is missing");
    plan->study.realizations = job.planned;
    Json answer =
        talus::distribution(*plan, quantity, store_.measure_sample(job, quantity, plan->study.stop_half_width), bins);
    drop_nulls(answer);
    return answer;
  });
}

Json Jobs::summary(const Job& job) const {
  const auto text = find_file(StudyPaths{data_.job(job.id)}.summary(), max_bytes);
  if (!text) throw Refusal(Reason::result_not_ready, "there are no statistics of this job");
  return Json::parse(*text);
}

std::string Jobs::field(const Job& job, std::int64_t index, bool svg) {
  const TemporaryDirectory scratch = scratch_directory();
  const fs::path file = scratch / (svg ? "field.svg" : "field.csv");
  const CommandOutput output =
      run(commands_.field({data_.job(job.id)}, realization(index), job.seed, file), seconds(60));
  check(output, "the field");
  const std::string text = read_file(file, max_bytes);
  if (svg) return text;
  Json json = Json::parse(output.out);
  CsvRows rows(text);
  rows.next();  // the header: x_m, y_m, friction_angle_deg, tan_phi
  for (const char* key : {"x_m", "y_m", "particle_friction_angle_deg"}) json[key] = Json::array();
  while (rows.next()) {
    const std::vector<std::string> fields = rows.fields();
    json["x_m"].push_back(to_number(fields.at(0)).value());
    json["y_m"].push_back(to_number(fields.at(1)).value());
    json["particle_friction_angle_deg"].push_back(to_number(fields.at(2)).value());
  }
  return dump(json);
}

std::string Jobs::profile(const Job& job, std::int64_t index, bool svg) {
  const StudyPaths study{data_.job(job.id)};
  fs::create_directories(study.profiles());
  const std::string extension = svg ? ".svg" : ".json";
  const fs::path kept = study.profiles() / (std::to_string(index) + extension);
  if (auto text = find_file(kept, max_bytes)) return *text;
  const TemporaryDirectory scratch = scratch_directory();
  const fs::path out = scratch / "run", file = scratch / ("profile" + extension);
  check(run(commands_.replay(study, realization(index), job.seed, out), seconds(3600), true), "the profile");
  check(run(commands_.profile(out, file), seconds(60)), "the profile");
  const std::string text = read_file(file, max_bytes);
  write_file_atomically(kept, text);
  prune(study.profiles());
  return text;
}

}  // namespace talus::service
