#include "jobs/jobs.hpp"

#include <algorithm>
#include <cmath>

#include "base/digest.hpp"
#include "jobs/job_record.hpp"
#include "jobs/repair.hpp"
#include "jobs/reserve.hpp"
#include "support/files.hpp"
#include "support/seed.hpp"
#include "support/text.hpp"

namespace talus::service {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr double evaluations_per_second = 15e6;  ///< of a core, see README
constexpr milliseconds histogram_age{1000};      ///< at most, while the job runs
constexpr int commands_at_a_time = 4, commands_of_one = 3, commands_waiting = 16, fields_at_a_time = 2;
constexpr std::size_t max_bytes = std::size_t{256} << 20;

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
    log_failure(output);
    if (output.end.signal || output.err.find("bad_alloc") != std::string::npos)
      throw Refusal(reason::unprocessable, "checking the case takes more memory or time than allowed");
    throw Refusal(reason::internal, "the case could not be checked");
  }
  if (faults.empty()) faults.push_back({pointer, output.err});
  throw Refusal(reason::bad_request, "the case cannot be run", std::move(faults));
}

Productions::Limits limits_of(const Config& config, int at_a_time) {
  return {.at_a_time = at_a_time,
          .waiting = config.streams,
          .waiting_of_one = config.tokens.empty() ? config.streams : config.streams_each};
}

/// Drops the members that are null or contain null: a statistic without a value.
void drop_nulls(Json& object) {
  const auto has_null = [](const Json& value) {
    return value.is_null() || (value.is_array() && std::find(value.begin(), value.end(), Json()) != value.end());
  };
  for (auto at = object.begin(); at != object.end();) at = has_null(*at) ? object.erase(at) : std::next(at);
}

}  // namespace

Jobs::Jobs(const Config& config, Store& store, Scheduler& scheduler)
    : config_(config),
      data_{config.data},
      data_watch_(data_),
      store_(store),
      scheduler_(scheduler),
      commands_("requests that check or change a study", commands_at_a_time,
                config.tokens.empty() ? commands_at_a_time : commands_of_one, commands_waiting),
      fields_(limits_of(config, fields_at_a_time)),
      runs_(limits_of(config, config.workers)) {}

void Jobs::stop() {
  stopping_ = true;
  fields_.stop();
  runs_.stop();
}

CommandOutput Jobs::run_command(std::vector<std::string> arguments, const Caller& caller) {
  const Shares::Share place = commands_.take(caller, 1, seconds(20));
  return run(short_command(config_, std::move(arguments)), command_limit,
             [&] { return stopping_ || caller.stop.stop_requested(); });
}

CommandOutput Jobs::prepare(const fs::path& case_file, const StudyPaths& directory, std::int64_t realizations,
                            std::int64_t seed, const Caller& caller) {
  return run_command({"study", case_file.string(), "--out", directory.root.string(), "--realizations",
                      std::to_string(realizations), "--seed", std::to_string(seed), "--prepare"},
                     caller);
}

CommandOutput Jobs::run(const Command& command, seconds limit, const Productions::Abandoned& abandoned) {
  bool given_up = false;
  CommandOutput output = run_to_end(command, data_.scratch(), limit, [&] { return given_up = abandoned(); });
  if (stopping_) throw Refusal(reason::unavailable, "talusd is stopping");
  if (given_up) throw Refusal(reason::unavailable, "nobody waits for the answer any more");
  if (output.timed_out)
    throw Refusal(reason::timeout, "this takes longer than " + std::to_string(limit.count()) + " s");
  const bool cut_short = !output.out.empty() && output.out.back() != '\n';
  if (!output.end.signal && (output.end.exit_code == Exit::io || cut_short)) {
    log_error("talus_cannot_write", {{"said", output.err}});
    if (disk_left(config_.data) < least_disk_bytes)
      throw Refusal(reason::disk_full, "no file can be written: the disk is full");
    throw Refusal(reason::unavailable, unusable(output.err));
  }
  return output;
}

TemporaryDirectory Jobs::scratch_directory() const {
  return TemporaryDirectory(data_.scratch() / random_hex(DataDirectory::scratch_bytes));
}

Json Jobs::validate(const Json& document, const std::string& pointer, const Caller& caller) {
  const Shares::Share place = commands_.take(caller, 1, seconds(20));
  return validate(document, pointer, [&] { return stopping_ || caller.stop.stop_requested(); });
}

Json Jobs::validate(const Json& document, const std::string& pointer, const Productions::Abandoned& abandoned) {
  const TemporaryDirectory scratch = scratch_directory();
  write_file_atomically(scratch / "case.json", dump(document));
  const CommandOutput output =
      run(short_command(config_, {"validate", scratch / "case.json", "--json"}), command_limit, abandoned);
  if (!output.ok()) refuse_case(output, pointer);
  Json demand = Json::parse(output.out, nullptr, false);
  if (demand.is_discarded()) throw Refusal(reason::unavailable, "the case could not be checked; try again");
  return demand;
}

std::size_t Jobs::field_terms(const Json& document, const Caller& caller) {
  if (!document.contains("random_field") || document.at("random_field").is_null()) return 0;
  return field_terms_.get(dump(document), 0, {}, [&]() -> Json {
    const Json demand = validate(document, "", caller);
    return demand.contains("field") ? demand.at("field").at("terms") : Json(0);
  });
}

void Jobs::check_queue(const std::string& subject) const {
  data_watch_.check();
  const auto check = [](std::int64_t open, std::int64_t most, const char* whose) {
    if (open >= most)
      throw Refusal(reason::queue_full,
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
    throw Refusal(reason::disk_full, "only " + std::to_string(left >> 20) + " MiB of disk are left; " +
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
  refuse_if_any(faults, reason::quota, "the job exceeds a quota");
}

std::optional<Job> Jobs::record(const NewJob& job, const Store::Response& response, Milliseconds created,
                                const std::optional<std::string>& echo_inputs) {
  std::optional<Job> recorded = store_.create(job, response, created, echo_inputs);
  data_watch_.check();  // a 201 means that the job is on the disk
  if (recorded) scheduler_.wake();
  return recorded;
}

std::optional<Job> Jobs::submit_study(const Submission& submission, const Store::Response& response) {
  const Caller& caller = submission.caller;
  check_queue(caller.subject);
  const StudyInputs study = read_study_inputs(submission.inputs);
  const Json demand = validate(study.document, "/inputs/case", caller);

  NewJob job{.id = random_hex(DataDirectory::id_bytes), .process = "influence-zone", .subject = caller.subject};
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
  const CommandOutput prepared = prepare(scratch / "case.json", directory, job.planned, job.seed, caller);
  if (!prepared.ok()) refuse_case(prepared, "/inputs/case");

  const Plan plan = find_plan(directory.root).value();
  job.title = plan.title;
  job.planned = plan.study.realizations;
  job.replicates = plan.study.noise_floor_replicates;
  job.max_failed_share = plan.study.max_failed_share;
  job.may_stop_early = plan.study.stop_half_width.has_value();
  job.case_hash = plan.of.hash;
  job.inputs = dump({{"quantity", study.quantity}, {"outputs", submission.outputs}, {"raw", submission.raw}});
  const Milliseconds now = system_now();
  write_job_record(made.path(), job, now);
  made.move_to(data_.job(job.id));
  std::optional<Job> recorded = record(job, response, now);
  if (recorded) made.keep();
  return recorded;
}

std::optional<Job> Jobs::submit_echo(const Submission& submission, const Store::Response& response) {
  const std::string& subject = submission.caller.subject;
  check_queue(subject);
  const Json kept = {
      {"outputs", submission.outputs}, {"raw", submission.raw}, {"pause", submission.inputs.value("pause", 0.0)}};
  const std::string values = dump(submission.inputs);
  check_echo(subject, values.size());
  return record({.id = random_hex(DataDirectory::id_bytes),
                 .process = "echo",
                 .subject = subject,
                 .title = "echo",
                 .inputs = dump(kept)},
                response, system_now(), values);
}

void Jobs::check_echo(const std::string& subject, std::size_t bytes) const {
  const auto check = [&](std::int64_t kept, std::uint64_t most, const char* whose) {
    if (static_cast<std::uint64_t>(kept) + bytes > most)
      throw Refusal(reason::queue_full,
                    std::string("echo jobs ") + whose + " keep " + std::to_string(kept >> 20) +
                        " MiB of inputs; at most " + std::to_string(most >> 20) +
                        " MiB may be kept: delete some of them",
                    {}, 60);
  };
  check(store_.echo_bytes({}), config_.quotas.echo_bytes, "of all");
  check(store_.echo_bytes(subject), config_.quotas.echo_bytes_of_one, "of yours");
}

void Jobs::dismiss(const Job& job) {
  with_reserve(data_, [&] { store_.dismiss(job.number); });
  scheduler_.wake(job.number);
}

bool Jobs::extend(const Job& job, std::int64_t more, const Store::Response& response) {
  if (job.may_stop_early) throw Refusal(reason::conflict, "a study that stops by itself cannot be extended");
  const std::lock_guard one_at_a_time(changing_study_);  // two at once would both add to the same number
  const std::int64_t planned = store_.job(job.number)->planned + more;
  ended(job.state) ? check_queue(job.subject) : check_disk();  // an ended one will be open again
  check_size(job.particles, job.steps, planned, "/realizations");
  const StudyPaths directory{data_.job(job.id)};
  const CommandOutput prepared = prepare(checked_case(data_, job), directory, planned, job.seed, {job.subject});
  if (!prepared.ok())
    throw Refusal(reason::conflict, prepared.err.empty() ? "the study cannot be extended" : prepared.err);
  const bool fresh = store_.extend(job.number, planned, response);
  scheduler_.wake(job.number);
  return fresh;
}

Json Jobs::evaluate(const Json& document, const Caller& caller) {
  const std::string text = dump(document);
  return parse_json(runs_.get("evaluation/" + sha256(text), caller, 2 * config_.time_limit,
                              [this, document](const Productions::Abandoned& abandoned) {
                                return make_evaluation(document, abandoned);
                              }),
                    "result.json");
}

std::string Jobs::make_evaluation(const Json& document, const Productions::Abandoned& abandoned) {
  const Json demand = validate(document, "", abandoned);
  check_size(particles_of(demand), demand.at("steps").get<double>(), 1);
  const TemporaryDirectory scratch = scratch_directory();
  write_file_atomically(scratch / "case.json", dump(document));
  const Command command = single_run(config_, {scratch / "case.json", "--seed", "0", "--out", scratch / "run"});
  const CommandOutput output = run(command, config_.time_limit, abandoned);
  if (!output.end.signal && output.end.exit_code == Exit::bad_case) throw Refusal(reason::bad_request, output.err);
  if (!output.ok()) throw Refusal(reason::internal, "the run failed: " + output.err);
  const Json result = read_json((scratch / "run") / "result.json", 1 << 20);
  for (const Json& why : result.at("quality").at("reasons"))
    if (why.at("verdict") == word(Verdict::invalid))
      throw Refusal(reason::internal,
                    "the run failed: its result is invalid, since " + why.at("message").get<std::string>());
  return dump(result);
}

Json Jobs::distribution(const Job& job, const Measure& quantity, const Bins& bins) {
  const std::string key =
      job.id + "/" + quantity.key + "/" + std::to_string(bins.count) + "/" + Json(bins.edges).dump();
  return distributions_.get(key, job.version, ended(job.state) ? milliseconds(0) : histogram_age, [&] {
    const Plan plan = plan_of(job);
    Json answer =
        talus::distribution(plan, quantity, store_.measure_sample(job, quantity, plan.study.stop_half_width), bins);
    drop_nulls(answer);
    return answer;
  });
}

Json Jobs::exceedance(const Job& job, const std::string& quantity, const std::optional<double>& x) {
  const std::string key = job.id + "/exceedance/" + quantity + "/" + (x ? to_text(*x) : "");
  return distributions_.get(key, job.version, ended(job.state) ? milliseconds(0) : histogram_age, [&] {
    const Plan plan = plan_of(job);
    const std::optional<StudyQuantity> of = find_quantity(quantity, plan.targets);
    if (!of)
      throw Refusal(reason::bad_request, "no such quantity",
                    {{"?quantity", in_quotes(quantity) + suggestion(quantity, quantity_names(plan.targets))}});
    const bool at_x = of->measure || of->number;
    if (at_x && !x) throw Refusal(reason::bad_request, "x is missing", {{"?x", "must be a number"}});
    Json answer = of->measure ? exceedance_at(*of->measure,
                                              store_.measure_sample(job, *of->measure, plan.study.stop_half_width), *x)
                              : exceedance_at(target_sample(job, plan, *of->target), of->number, x.value_or(0.0));
    drop_nulls(answer);
    return answer;
  });
}

TargetSample Jobs::target_sample(const Job& job, const Plan& plan, std::size_t target) {
  StudySummary summary(plan);
  store_.records(job.number, RunKind::realization)([&](const Record& record) { summary.add(record); });
  return summary.target_sample(target);
}

Json Jobs::summary(const Job& job) {
  const fs::path file = StudyPaths{data_.job(job.id)}.summary();
  const auto read = [&] {
    Json summary = read_json(file, max_bytes);
    summary.erase("checksum");  // of the file
    return summary;
  };
  try {
    return read();
  } catch (const IoError& e) {
    log_error("made_again", {{"job", job.id}, {"file", file.string()}, {"why", e.what()}});
  }
  publish_again(job);
  return read();
}

}  // namespace talus::service
