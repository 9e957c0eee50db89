#include "jobs/jobs.hpp"

#include <cmath>

#include "base/digest.hpp"
#include "support/files.hpp"
#include "support/seed.hpp"

namespace talus::service {
namespace {

using std::chrono::seconds;

constexpr double evaluations_per_second = 15e6;  ///< of a core, see README

/// Which program or file `talus` could not use, from its error output.
const char* unusable(const std::string& said) {
  const auto has = [&said](const char* words) { return said.find(words) != std::string::npos; };
  if (has("gnuplot not found")) return "gnuplot, which draws the pictures, is missing here";
  if (has("gnuplot failed") || has("cannot start gnuplot"))
    return "gnuplot, which draws the pictures, could not be run";
  return "a file of the service cannot be read or written";
}

/// A count without a decimal point: 51, not 51.0.
std::string text(double value) {
  std::string digits = Json(value).dump();
  if (digits.ends_with(".0")) digits.resize(digits.size() - 2);
  return digits;
}

double core_hours(double particles, double steps, double runs) {
  return 2.0 * particles * steps * runs / evaluations_per_second / 3600.0;
}

double particles_of(const Json& demand) {
  const Json& particles = demand.at("particles");
  return particles.at("soil").get<double>() + particles.at("wall").get<double>();
}

/// A case that `talus` rejects or cannot process.
[[noreturn]] void refuse_case(const CommandOutput& output, const std::string& pointer) {
  std::vector<Fault> faults;
  const Json said = Json::parse(output.out, nullptr, false);
  if (said.is_object() && said.contains("faults"))
    for (const Json& fault : said.at("faults"))
      faults.push_back({pointer + fault.at("pointer").get<std::string>(), fault.at("message").get<std::string>()});
  if (output.end.signal || (faults.empty() && output.end.exit_code != Exit::bad_case)) {
    log_error("talus_failed",
              {{"exit_code", output.end.exit_code}, {"signal", output.end.signal}, {"said", output.err}});
    if (output.end.signal || output.err.find("bad_alloc") != std::string::npos)
      throw Refusal(Reason::unprocessable, "checking the case takes more memory or time than allowed");
    throw Refusal(Reason::internal, "the case could not be checked");
  }
  if (faults.empty()) faults.push_back({pointer, output.err});
  throw Refusal(Reason::bad_request, "the case cannot be run", std::move(faults));
}

}  // namespace

CommandOutput Jobs::run(const Command& command, std::chrono::milliseconds limit, bool is_long) {
  const auto patience = is_long ? seconds(60) : seconds(20);
  if (!(is_long ? long_commands_.try_acquire_for(patience) : short_commands_.try_acquire_for(patience)))
    throw Refusal(Reason::unavailable, "too many requests of this kind at once", {}, 10);
  struct Releaser {
    Jobs& jobs;
    bool is_long;
    ~Releaser() { is_long ? jobs.long_commands_.release() : jobs.short_commands_.release(); }
  } const releaser{*this, is_long};
  CommandOutput output = run_to_end(command, data_.scratch(), limit, [this] { return stopping_.load(); });
  if (stopping_) throw Refusal(Reason::unavailable, "talusd is stopping");
  if (output.timed_out)
    throw Refusal(Reason::timeout, "this takes longer than " + std::to_string(limit.count() / 1000) + " s");
  const bool cut_short = !output.out.empty() && output.out.back() != '\n';
  if (!output.end.signal && (output.end.exit_code == Exit::io || cut_short)) {
    log_error("talus_cannot_write", {{"said", output.err}});
    if (disk_left(config_.data) < least_disk_bytes)
      throw Refusal(Reason::disk_full, "no file can be written: the disk is full");
    throw Refusal(Reason::unavailable, unusable(output.err));
  }
  return output;
}

TemporaryDirectory Jobs::scratch_directory() const { return TemporaryDirectory(data_.scratch() / random_hex(8)); }

Json Jobs::validate(const Json& document, const std::string& pointer) {
  const TemporaryDirectory scratch = scratch_directory();
  write_file_atomically(scratch / "case.json", dump(document));
  const CommandOutput output = run(commands_.validate(scratch / "case.json"), seconds(60));
  if (!output.ok()) refuse_case(output, pointer);
  Json demand = Json::parse(output.out, nullptr, false);
  if (demand.is_discarded()) throw Refusal(Reason::unavailable, "the case could not be checked; try again");
  return demand;
}

std::size_t Jobs::field_terms(const Json& document) {
  if (!document.contains("random_field") || document.at("random_field").is_null()) return 0;
  return field_terms_.get(dump(document), 0, {}, [&]() -> Json {
    const Json demand = validate(document, "");
    return demand.contains("field") ? demand.at("field").at("terms") : Json(0);
  });
}

void Jobs::check_queue(const std::string& subject) const {
  const auto check = [](std::int64_t open, std::int64_t most, const char* whose) {
    if (open >= most)
      throw Refusal(Reason::queue_full,
                    std::string(whose) + " " + std::to_string(open) + " jobs are waiting or running; at most " +
                        std::to_string(most) + " may",
                    {}, 60);
  };
  check(store_.open_jobs({}), config_.quotas.open_jobs, "in all");
  check(store_.open_jobs(subject), config_.quotas.open_jobs_of_one, "of yours");
  check_disk();
}

void Jobs::check_disk() const {
  const std::uint64_t left = disk_left(config_.data);
  if (left < config_.quotas.disk_bytes)
    throw Refusal(Reason::disk_full, "only " + std::to_string(left >> 20) + " MiB of disk are left; " +
                                         std::to_string(config_.quotas.disk_bytes >> 20) + " must stay free");
}

void Jobs::check_size(double particles, double steps, std::int64_t realizations,
                      const std::string& common_pointer) const {
  Faults faults;
  const auto at_most = [&](const char* pointer, const char* what, double asked, double most) {
    if (asked > most)
      faults.add(common_pointer.empty() ? pointer : common_pointer,
                 std::string(what) + ": " + text(asked) + ", at most " + text(most));
  };
  const double hours = core_hours(particles, steps, static_cast<double>(realizations));
  at_most("/inputs/case/particle_spacing_m", "particles", particles, config_.quotas.particles);
  at_most("/inputs/case/time/end_s", "steps of a run", steps, config_.quotas.steps);
  at_most("/inputs/realizations", "realizations", static_cast<double>(realizations),
          static_cast<double>(config_.quotas.realizations));
  at_most("/inputs", "estimated core-hours", std::round(10.0 * hours) / 10.0, config_.quotas.core_hours);
  refuse_if_any(faults, Reason::quota, "the job exceeds a quota");
}

std::optional<Job> Jobs::record(const NewJob& job, const Store::Response& response) {
  std::optional<Job> recorded = store_.create(job, response);
  if (recorded) scheduler_.wake();
  return recorded;
}

std::optional<Job> Jobs::submit_study(const std::string& subject, const Json& inputs,
                                      const std::vector<std::string>& outputs, bool raw,
                                      const Store::Response& response) {
  check_queue(subject);
  const StudyInputs study = read_study_inputs(inputs);
  const Json demand = validate(study.document, "/inputs/case");

  NewJob job{.id = random_hex(16), .process = "influence-zone", .subject = subject};
  const Json& options = study.document.at("study");
  job.planned = options.value("realizations", std::int64_t{100});
  job.seed =
      options.contains("seed") ? options.at("seed").get<std::int64_t>() : static_cast<std::int64_t>(random_seed());
  job.particles = particles_of(demand);
  job.steps = demand.at("steps").get<double>();
  check_size(job.particles, job.steps, job.planned);
  const TemporaryDirectory scratch = scratch_directory();
  write_file_atomically(scratch / "case.json", dump(study.document));
  TemporaryDirectory made(data_.unfinished(job.id));
  const StudyPaths directory{made.path()};
  const CommandOutput prepared =
      run(commands_.prepare(scratch / "case.json", directory, job.planned, job.seed), seconds(60));
  if (!prepared.ok()) refuse_case(prepared, "/inputs/case");

  const Plan plan = find_plan(directory.root).value();
  job.title = plan.title;
  job.planned = plan.study.realizations;
  job.replicates = plan.study.noise_floor_replicates;
  job.max_failed_share = plan.study.max_failed_share;
  job.may_stop_early = plan.study.stop_half_width.has_value();
  job.case_hash = plan.case_hash;
  job.inputs = dump({{"quantity", study.quantity}, {"outputs", outputs}, {"raw", raw}});
  made.move_to(data_.job(job.id));
  std::optional<Job> recorded = record(job, response);
  if (recorded) made.keep();
  return recorded;
}

std::optional<Job> Jobs::submit_echo(const std::string& subject, const Json& inputs,
                                     const std::vector<std::string>& outputs, bool raw,
                                     const Store::Response& response) {
  check_queue(subject);
  const Json kept = {{"outputs", outputs}, {"raw", raw}, {"pause", inputs.value("pause", 0.0)}, {"inputs", inputs}};
  return record({.id = random_hex(16), .process = "echo", .subject = subject, .title = "echo", .inputs = dump(kept)},
                response);
}

void Jobs::dismiss(const Job& job) {
  store_.dismiss(job.number);
  scheduler_.wake(job.number);
}

void Jobs::retry(const Job& job, const Store::Response& response) {
  if (ended(job.state)) check_queue(job.subject);  // it will be open again
  store_.retry_failed(job.number, response);
  scheduler_.wake(job.number);
}

bool Jobs::extend(const Job& job, std::int64_t more, const Store::Response& response) {
  if (job.may_stop_early) throw Refusal(Reason::conflict, "a study that stops by itself cannot be extended");
  const std::lock_guard one_at_a_time(extending_);  // two at once would both add to the same number
  const std::int64_t planned = store_.job(job.number)->planned + more;
  ended(job.state) ? check_queue(job.subject) : check_disk();  // an ended one will be open again
  check_size(job.particles, job.steps, planned, "/realizations");
  const StudyPaths directory{data_.job(job.id)};
  const CommandOutput prepared =
      run(commands_.prepare(directory.resolved_case(), directory, planned, job.seed), seconds(60));
  if (!prepared.ok())
    throw Refusal(Reason::conflict, prepared.err.empty() ? "the study cannot be extended" : prepared.err);
  const bool fresh = store_.extend(job.number, planned, response);
  scheduler_.wake(job.number);
  return fresh;
}

Json Jobs::evaluate(const Json& document) {
  const Json demand = validate(document, "");
  check_size(particles_of(demand), demand.at("steps").get<double>(), 1);
  const TemporaryDirectory scratch = scratch_directory();
  write_file_atomically(scratch / "case.json", dump(document));
  const CommandOutput output = run(commands_.median(scratch / "case.json", scratch / "run"), config_.time_limit, true);
  if (!output.end.signal && output.end.exit_code == Exit::bad_case) throw Refusal(Reason::bad_request, output.err);
  if (!output.ok()) throw Refusal(Reason::internal, "the run failed: " + output.err);
  return read_json((scratch / "run") / "result.json", 1 << 20);
}

}  // namespace talus::service
