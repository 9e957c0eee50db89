// What is read from a job's files or asked of talus about them.

#include <algorithm>

#include "base/digest.hpp"
#include "base/log.hpp"
#include "jobs/jobs.hpp"
#include "support/files.hpp"

namespace talus::service {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr milliseconds behind{1000};       ///< that the histogram of a running job may be
constexpr std::size_t profiles_kept = 16;  ///< of a job
constexpr std::size_t max_bytes = std::size_t{256} << 20;

/// Removes all but the newest few profiles that were asked for; those that the study keeps itself stay.
void prune(const fs::path& directory, std::size_t keep) {
  std::vector<std::pair<fs::file_time_type, fs::path>> files;
  for (const auto& entry : fs::directory_iterator(directory))
    if (run_of_work_name(entry.path().stem().string())) files.emplace_back(entry.last_write_time(), entry.path());
  std::sort(files.rbegin(), files.rend());
  std::error_code ignored;
  for (std::size_t i = keep; i < files.size(); ++i) fs::remove(files[i].second, ignored);
}

[[noreturn]] void broke(const CommandOutput& outcome, const char* what) {
  log_error("talus_broke",
            {{"exit_code", outcome.end.exit_code}, {"signal", outcome.end.signal}, {"said", outcome.err}});
  throw Refusal(Reason::internal, std::string(what) + " could not be made");
}

/// Leaves out what has no value: `talus` says null.
void drop_nulls(Json& object) {
  const auto has_null = [](const Json& value) {
    return value.is_null() || (value.is_array() && std::any_of(value.begin(), value.end(),
                                                               [](const Json& item) { return item.is_null(); }));
  };
  for (auto at = object.begin(); at != object.end();) at = has_null(*at) ? object.erase(at) : std::next(at);
}

/// A directory for one command, gone afterwards.
struct Scratch {
  explicit Scratch(const fs::path& parent) : path(parent / random_hex(8)) { fs::create_directories(path); }
  ~Scratch() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  fs::path path;
};

}  // namespace

Json Jobs::distribution(const Job& job, const Measure& quantity, const Bins& bins) {
  const std::string key =
      job.id + "/" + quantity.key + "/" + std::to_string(bins.count) + "/" + Json(bins.edges).dump();
  return distributions_.get(key, job.version, ended(job.state) ? milliseconds(0) : behind, [&] {
    std::optional<Plan> plan = find_plan(data_.job(job.id));
    if (!plan) throw Refusal(Reason::internal, "the plan of the job is missing");
    plan->study.realizations = job.planned;
    const MeasureSample sample = store_.measure_sample(job, quantity, plan->study.stop_half_width);
    Json answer = talus::distribution(*plan, quantity, sample, bins);
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
  const Scratch scratch(data_.scratch());
  const fs::path file = scratch.path / (svg ? "field.svg" : "field.csv");
  const CommandOutput outcome =
      run(commands_.field({data_.job(job.id)}, realization(index), job.seed, file), seconds(60));
  if (outcome.end.signal || outcome.end.exit_code != 0) broke(outcome, "the field");
  const std::string text = find_file(file, max_bytes).value_or("");
  if (svg) return text;
  Json json = Json::parse(outcome.out);
  // The columns of the table: x_m, y_m, friction_angle_deg, tan_phi.
  std::array<Json, 3> columns{Json::array(), Json::array(), Json::array()};
  std::size_t line = text.find('\n');
  while (line != std::string::npos && line + 1 < text.size()) {
    const char* at = text.c_str() + line + 1;
    for (Json& column : columns) {
      char* end = nullptr;
      column.push_back(std::strtod(at, &end));
      at = end + 1;
    }
    line = text.find('\n', line + 1);
  }
  json["x_m"] = std::move(columns[0]);
  json["y_m"] = std::move(columns[1]);
  json["particle_friction_angle_deg"] = std::move(columns[2]);
  return dump(json);
}

std::string Jobs::profile(const Job& job, std::int64_t index, bool svg) {
  const StudyPaths study{data_.job(job.id)};
  fs::create_directories(study.profiles());
  const fs::path kept = study.profiles() / (std::to_string(index) + (svg ? ".svg" : ".json"));
  if (auto text = find_file(kept, max_bytes)) return *text;
  const Scratch scratch(data_.scratch());
  const fs::path out = scratch.path / "run";
  const CommandOutput again = run(commands_.replay(study, realization(index), job.seed, out), seconds(3600), true);
  if (again.end.signal || again.end.exit_code != 0) broke(again, "the profile");
  const fs::path json = scratch.path / "profile.json", picture = scratch.path / "profile.svg";
  const fs::path& wanted = svg ? picture : json;
  const CommandOutput made = run(commands_.profile(out, wanted), seconds(60));
  if (made.end.signal || made.end.exit_code != 0) broke(made, "the profile");
  const std::string text = find_file(wanted, max_bytes).value_or("");
  write_file_atomically(kept, text);
  prune(study.profiles(), profiles_kept);
  return text;
}

Json Jobs::evaluate(const Json& document) {
  const Json demand = validate(document, ""), &particles = demand.at("particles");
  const double count = particles.at("soil").get<double>() + particles.at("wall").get<double>();
  check_size(count, demand.at("steps").get<double>(), 1);
  const Scratch scratch(data_.scratch());
  write_file_atomically(scratch.path / "case.json", dump(document));
  const CommandOutput outcome =
      run(commands_.median(scratch.path / "case.json", scratch.path / "run"), config_.time_limit, true);
  if (outcome.end.exit_code == 3 && !outcome.end.signal) throw Refusal(Reason::bad_request, outcome.err);
  const auto text = find_file(scratch.path / "run" / "result.json", 1 << 20);
  if (outcome.end.signal || outcome.end.exit_code != 0 || !text)
    throw Refusal(Reason::internal, "the run failed: " + outcome.err);
  return Json::parse(*text);
}

}  // namespace talus::service
