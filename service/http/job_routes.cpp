// /jobs, /jobs/{id}, /jobs/{id}/results

#include <algorithm>

#include "http/lookup.hpp"
#include "http/results.hpp"
#include "http/text.hpp"

namespace talus::service {
namespace {

/// Every value of a parameter that may stand more than once and hold a list.
std::vector<std::string> values_of(const Incoming& request, const std::string& name) {
  std::vector<std::string> all;
  const auto [first, last] = request.query.equal_range(name);
  for (auto at = first; at != last; ++at)
    for (std::string& value : split(at->second, ',')) all.push_back(std::move(value));
  return all;
}

/// A date-time of RFC 3339, or two with a slash between, of which one may be ".." or missing.
void read_datetime(const std::string& text, JobFilter& filter) {
  const auto end_of = [](const std::string& part) -> std::optional<Milliseconds> {
    if (part.empty() || part == "..") return std::nullopt;
    const auto time = utc_time(part);
    if (!time)
      bad_parameter("datetime",
                    "must be a date-time (2026-01-31T12:00:00Z) or an interval (DATETIME/DATETIME, ../DATETIME)");
    return time;
  };
  const std::size_t slash = text.find('/');
  filter.created_from = end_of(text.substr(0, slash));
  filter.created_to = slash == std::string::npos ? filter.created_from : end_of(text.substr(slash + 1));
  if (!filter.created_from && !filter.created_to) bad_parameter("datetime", "an interval needs at least one end");
}

JobFilter filter_of(const Exchange& exchange) {
  constexpr std::int64_t most_seconds = std::int64_t{1} << 40;
  const Incoming& request = exchange.request;
  only_parameters(request, {"limit", "status", "processID", "type", "datetime", "minDuration", "maxDuration", "after"});
  JobFilter filter{.subject = exchange.subject};
  filter.limit = page_limit(request);
  filter.before = whole_number(request, "after", 0, std::int64_t{1} << 62);
  for (const std::string& name : values_of(request, "status")) {
    const auto state = job_state(name);
    if (!state) bad_parameter("status", "must be accepted, running, successful, failed or dismissed");
    filter.states.push_back(*state);
  }
  filter.processes = values_of(request, "processID");
  const std::vector<std::string> types = values_of(request, "type");
  if (std::any_of(types.begin(), types.end(), [](const std::string& type) { return type != "process"; }))
    bad_parameter("type", "must be process");
  if (const auto text = request.parameter("datetime")) read_datetime(*text, filter);
  if (const auto least = whole_number(request, "minDuration", 0, most_seconds)) filter.least_duration = 1000 * *least;
  if (const auto most = whole_number(request, "maxDuration", 0, most_seconds)) filter.most_duration = 1000 * *most;
  return filter;
}

Answer list_jobs(Exchange& exchange) {
  JobFilter filter = filter_of(exchange);
  const auto limit = static_cast<std::size_t>(filter.limit++);  // one more, to see whether there is more
  std::vector<Job> jobs = exchange.service.store.jobs(filter);
  const bool more = jobs.size() > limit;
  if (more) jobs.resize(limit);
  Json all = Json::array(),
       links = Json::array({link(exchange, "/jobs" + query_text(exchange.request), "self", "Jobs")});
  for (const Job& job : jobs) all.push_back(status_info(job, exchange));
  if (more) {
    const std::string next = query_text(exchange.request, {{"after", std::to_string(jobs.back().number)}});
    links.push_back(link(exchange, "/jobs" + next, "next", "The next jobs"));
  }
  return json_answer({{"jobs", all}, {"links", links}});
}

Answer results(Exchange& exchange) {
  const Job job = job_of(exchange);
  if (job.state == JobState::dismissed) throw Refusal(Reason::job_dismissed, "the job was dismissed");
  if (job.state == JobState::failed) throw Refusal(Reason::unprocessable, "the job failed: " + job.message);
  if (job.state != JobState::successful) throw Refusal(Reason::result_not_ready, "the job is still running");
  const Json asked = Json::parse(job.inputs);
  const auto outputs = asked.at("outputs").get<std::vector<std::string>>();
  const bool raw = asked.value("raw", false);
  if (job.process == "echo") return results_answer(echo_results(asked.at("inputs"), outputs), raw, exchange.request);
  Json values = Json::object();
  for (const std::string& output : outputs) {
    if (output == "summary") values[output] = exchange.service.jobs.summary(job);
    if (output == "histogram")
      values[output] = exchange.service.jobs.distribution(job, quantity_of(asked.at("quantity"), ""), {});
  }
  return results_answer(values, raw, exchange.request);
}

Answer dismiss(Exchange& exchange) {
  const Job job = job_of(exchange);
  exchange.service.jobs.dismiss(job);
  return json_answer(status_info(*exchange.service.store.job(job.id), exchange));
}

}  // namespace

Routes job_routes() {
  return {{"GET", "/jobs", Role::read, list_jobs},
          {"GET", "/jobs/{}", Role::read, [](Exchange& e) { return json_answer(status_info(job_of(e), e)); }},
          {"DELETE", "/jobs/{}", Role::submit, dismiss},
          {"GET", "/jobs/{}/results", Role::read, results}};
}

}  // namespace talus::service
