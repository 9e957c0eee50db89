#include "jobs/jobs.hpp"

#include <algorithm>
#include <cmath>

#include "base/digest.hpp"
#include "base/log.hpp"
#include "support/files.hpp"
#include "support/seed.hpp"
#include "support/text.hpp"

namespace talus::service {
namespace {

namespace fs = std::filesystem;
using std::chrono::seconds;

constexpr double evaluations_per_second = 15e6;  ///< of a core, see README

constexpr std::uint64_t crowded_bytes = std::uint64_t{16} << 20;  ///< with less, a failed write is put down to the disk

/// A directory that is gone unless it is kept.
class NewDirectory {
 public:
  explicit NewDirectory(fs::path path) : path_(std::move(path)) {
    std::error_code error;
    fs::create_directories(path_, error);
    if (error) throw_io_error("create", path_, error.value());
  }
  ~NewDirectory() {
    std::error_code ignored;
    if (!kept_) fs::remove_all(path_, ignored);
  }
  NewDirectory(const NewDirectory&) = delete;
  NewDirectory& operator=(const NewDirectory&) = delete;
  /// Moves it to its final place; still gone unless it is kept.
  void move_to(const fs::path& place) {
    rename_durably(path_, place);
    path_ = place;
  }
  void keep() { kept_ = true; }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
  bool kept_ = false;
};

/// Which of its means `talus` says it could not use.
const char* unusable(const std::string& said) {
  const auto has = [&said](const char* words) { return said.find(words) != std::string::npos; };
  if (has("gnuplot not found")) return "gnuplot, which draws the pictures, is missing here";
  if (has("gnuplot failed") || has("cannot start gnuplot"))
    return "gnuplot, which draws the pictures, could not be run";
  return "a file of the service cannot be read or written";
}

/// As people write it: 51, not 51.0.
std::string text(double value) {
  std::string digits = Json(value).dump();
  if (digits.ends_with(".0")) digits.resize(digits.size() - 2);
  return digits;
}

double core_hours(double particles, double steps, double runs) {
  return 2.0 * particles * steps * runs / evaluations_per_second / 3600.0;
}

}  // namespace

Jobs::Jobs(const Config& config, Store& store, Scheduler& scheduler, Changes& changes)
    : config_(config),
      data_{config.data},
      store_(store),
      scheduler_(scheduler),
      changes_(changes),
      commands_(config),
      heavy_(config.workers) {}

CommandOutput Jobs::run(const Command& command, std::chrono::milliseconds limit, bool heavy) {
  const auto patience = heavy ? seconds(60) : seconds(20);
  if (!(heavy ? heavy_.try_acquire_for(patience) : quick_.try_acquire_for(patience))) {
    Refusal busy(Reason::unavailable, "too many requests of this kind at once");
    busy.retry_after = 10;
    throw busy;
  }
  struct Releaser {
    Jobs& jobs;
    bool heavy;
    ~Releaser() { heavy ? jobs.heavy_.release() : jobs.quick_.release(); }
  } const releaser{*this, heavy};
  CommandOutput outcome = run_to_end(command, data_.scratch(), limit, [this] { return stopping_.load(); });
  if (stopping_) throw Refusal(Reason::unavailable, "talusd is stopping");
  if (outcome.timed_out)
    throw Refusal(Reason::timeout, "this takes longer than " + std::to_string(limit.count() / 1000) + " s");
  // Its own word for "cannot read or write", or an answer cut short.
  constexpr int io_exit = 5;
  const bool cut_short = outcome.out.empty() ? false : outcome.out.back() != '\n';
  if (!outcome.end.signal && (outcome.end.exit_code == io_exit || cut_short)) {
    log_error("talus_cannot_write", {{"said", outcome.err}});
    if (disk_left(config_.data) < crowded_bytes)
      throw Refusal(Reason::disk_full, "no file can be written for want of room");
    throw Refusal(Reason::unavailable, unusable(outcome.err));
  }
  return outcome;
}

void Jobs::refuse_case(const CommandOutput& outcome, const std::string& pointer) const {
  std::vector<Fault> faults;
  const Json said = Json::parse(outcome.out, nullptr, false);
  if (said.is_object() && said.contains("faults"))
    for (const Json& fault : said.at("faults"))
      faults.push_back({pointer + fault.at("pointer").get<std::string>(), fault.at("message").get<std::string>()});
  if (outcome.end.signal || (faults.empty() && outcome.end.exit_code != 3)) {
    log_error("talus_broke",
              {{"exit_code", outcome.end.exit_code}, {"signal", outcome.end.signal}, {"said", outcome.err}});
    if (outcome.end.signal || outcome.err.find("bad_alloc") != std::string::npos)
      throw Refusal(Reason::unprocessable, "the case takes more memory or time than it may to be looked at");
    throw Refusal(Reason::internal, "the case could not be checked");
  }
  if (faults.empty()) faults.push_back({pointer, outcome.err});
  throw Refusal(Reason::bad_request, "the case cannot be run", std::move(faults));
}

Json Jobs::validate(const Json& document, const std::string& pointer) {
  const NewDirectory scratch(data_.scratch() / ("case-" + random_hex(8)));
  write_file_atomically(scratch.path() / "case.json", dump(document));
  const CommandOutput outcome = run(commands_.validate(scratch.path() / "case.json"), seconds(60));
  if (outcome.end.signal || outcome.end.exit_code != 0) refuse_case(outcome, pointer);
  Json demand = Json::parse(outcome.out, nullptr, false);
  if (demand.is_discarded()) throw Refusal(Reason::unavailable, "the case could not be checked; try again");
  return demand;
}

void Jobs::check_queue(const std::string& subject) const {
  const auto refuse = [](std::int64_t open, std::int64_t most, const char* whose) {
    Refusal full(Reason::queue_full, std::string(whose) + " " + std::to_string(open) +
                                         " jobs are waiting or running; at most " + std::to_string(most) + " may");
    full.retry_after = 60;
    throw full;
  };
  const std::int64_t all = store_.open_jobs({}), mine = store_.open_jobs(subject);
  if (all >= config_.quotas.open_jobs) refuse(all, config_.quotas.open_jobs, "in all");
  if (mine >= config_.quotas.open_jobs_of_one) refuse(mine, config_.quotas.open_jobs_of_one, "of yours");
  check_disk();
}

void Jobs::check_disk() const {
  const std::uint64_t left = disk_left(config_.data);
  if (left < config_.quotas.disk_bytes)
    throw Refusal(Reason::disk_full, "only " + std::to_string(left >> 20) + " MiB of disk are left; " +
                                         std::to_string(config_.quotas.disk_bytes >> 20) + " must stay free");
}

void Jobs::check_size(double particles, double steps, std::int64_t realizations, const std::string& only_at) const {
  Checker check;
  const auto at_most = [&](const char* pointer, const char* what, double asked, double most) {
    if (asked > most)
      check.fault(only_at.empty() ? pointer : only_at,
                  std::string(what) + ": " + text(asked) + ", at most " + text(most));
  };
  const double hours = core_hours(particles, steps, static_cast<double>(realizations));
  at_most("/inputs/case/particle_spacing_m", "particles", particles, config_.quotas.particles);
  at_most("/inputs/case/time/end_s", "steps of a run", steps, config_.quotas.steps);
  at_most("/inputs/realizations", "realizations", static_cast<double>(realizations),
          static_cast<double>(config_.quotas.realizations));
  at_most("/inputs", "estimated core-hours", std::round(10.0 * hours) / 10.0, config_.quotas.core_hours);
  check.finish(Reason::quota, "the job is larger than a job may be here");
}

std::optional<Job> Jobs::submit_study(const std::string& subject, const Json& inputs,
                                      const std::vector<std::string>& outputs, bool raw, const Store::Answer& answer) {
  check_queue(subject);
  const StudyInputs study = read_study_inputs(inputs);
  const Json demand = validate(study.document, "/inputs/case");

  NewJob job{.id = random_hex(16), .process = "influence-zone", .subject = subject};
  NewDirectory made(data_.unfinished(job.id));
  const StudyPaths directory{made.path()};
  const fs::path scratch = data_.scratch() / (job.id + ".json");
  write_file_atomically(scratch, dump(study.document));
  const Json& options = study.document.at("study");
  job.planned = options.value("realizations", std::int64_t{100});
  job.seed =
      options.contains("seed") ? options.at("seed").get<std::int64_t>() : static_cast<std::int64_t>(random_seed());
  job.particles = demand.at("particles").at("soil").get<double>() + demand.at("particles").at("wall").get<double>();
  job.steps = demand.at("steps").get<double>();
  check_size(job.particles, job.steps, job.planned);
  const CommandOutput prepared = run(commands_.prepare(scratch, directory, job.planned, job.seed), seconds(60));
  fs::remove(scratch);
  if (prepared.end.signal || prepared.end.exit_code != 0) refuse_case(prepared, "/inputs/case");

  const Json plan = Json::parse(find_file(directory.plan(), 1 << 24).value_or("null"));
  job.title = plan.at("title").get<std::string>();
  job.planned = plan.at("realizations").get<std::int64_t>();
  job.floor = plan.at("noise_floor_replicates").get<std::int64_t>();
  job.max_failed_share = plan.at("max_failed_share").get<double>();
  job.may_stop_early = !plan.at("stop_when_ci_half_width_below_m").is_null();
  job.case_hash = plan.at("case_hash").get<std::string>();
  job.inputs = dump({{"quantity", study.quantity}, {"outputs", outputs}, {"raw", raw}});
  made.move_to(data_.job(job.id));
  std::optional<Job> row = store_.create(job, answer);
  if (!row) return row;
  made.keep();
  scheduler_.wake();
  changes_.announce();
  return row;
}

std::optional<Job> Jobs::submit_echo(const std::string& subject, const Json& inputs,
                                     const std::vector<std::string>& outputs, bool raw, const Store::Answer& answer) {
  check_queue(subject);
  Json kept = {{"outputs", outputs}, {"raw", raw}, {"pause", inputs.value("pause", 0.0)}, {"inputs", inputs}};
  std::optional<Job> row = store_.create(
      {.id = random_hex(16), .process = "echo", .subject = subject, .title = "echo", .inputs = dump(kept)}, answer);
  if (row) scheduler_.wake();
  if (row) changes_.announce();
  return row;
}

void Jobs::dismiss(const Job& job) {
  store_.dismiss(job.number);
  scheduler_.wake(job.number);
  changes_.announce();
}

std::int64_t Jobs::retry(const Job& job, const Store::Answer& answer) {
  if (job.process != "influence-zone" || job.state == JobState::dismissed)
    throw Refusal(Reason::conflict, "this job has no realizations");
  if (ended(job.state)) check_queue(job.subject);  // it will be open again
  const std::int64_t retried = store_.retry_failed(job.number, answer);
  scheduler_.wake(job.number);
  changes_.announce();
  return retried;
}

bool Jobs::extend(const Job& job, std::int64_t more, const Store::Answer& answer) {
  if (job.process != "influence-zone" || job.state == JobState::dismissed)
    throw Refusal(Reason::conflict, "this job has no realizations");
  if (job.may_stop_early) throw Refusal(Reason::conflict, "a study that stops by itself cannot be extended");
  const std::lock_guard one_at_a_time(extending_);  // two at once would both add to the same number
  const std::int64_t planned = store_.job(job.id)->planned + more;
  ended(job.state) ? check_queue(job.subject) : check_disk();  // an ended one will be open again
  check_size(job.particles, job.steps, planned, "/realizations");
  const StudyPaths directory{data_.job(job.id)};
  const CommandOutput prepared =
      run(commands_.prepare(directory.resolved_case(), directory, planned, job.seed), seconds(60));
  if (prepared.end.signal || prepared.end.exit_code != 0)
    throw Refusal(Reason::conflict, prepared.err.empty() ? "the study cannot be extended" : prepared.err);
  const bool fresh = store_.extend(job.number, planned, answer);
  scheduler_.wake(job.number);
  changes_.announce();
  return fresh;
}

}  // namespace talus::service
