// From the submission of a job to its results: /processes/{id}/execution, /jobs, /jobs/{id}, /jobs/{id}/results

#include <algorithm>
#include <thread>

#include "base/digest.hpp"
#include "http/lookup.hpp"
#include "http/text.hpp"

namespace talus::service {
namespace {

/// An object can only stand in a results document as a qualified value.
Json document_of(const Json& values) {
  Json document = Json::object();
  for (const auto& [name, value] : values.items())
    document[name] = value.is_object() ? Json({{"value", value}, {"mediaType", "application/json"}}) : value;
  return document;
}

Answer raw_answer(const Json& value) {
  if (value.is_string()) return {.type = "text/plain", .body = value.get<std::string>()};
  return json_answer(value);
}

bool accepts_multipart(const std::string& accept) {
  return accept.empty() || accept.find("*/*") != std::string::npos || accept.find("multipart/") != std::string::npos;
}

/// RFC 2387; each part bears the name of its output as Content-ID (OGC 18-062r2, process-execute-sync-raw-value-multi).
Answer multipart_answer(const Json& values) {
  const std::string boundary = sha256(dump(values)).substr(0, 32);
  std::string body, first_type;
  for (const auto& [name, value] : values.items()) {
    const Answer part = raw_answer(value);
    if (first_type.empty()) first_type = part.type;
    body += "--" + boundary + "\r\nContent-Type: " + part.type + "\r\nContent-ID: " + name + "\r\n\r\n" + part.body +
            "\r\n";
  }
  return {.type = "multipart/related; boundary=" + boundary + "; type=\"" + first_type + "\"",
          .body = body + "--" + boundary + "--\r\n"};
}

/// A results document; or, of a request with "response": "raw", the value itself, and of several values a
/// multipart/related, unless the client accepts JSON alone.
/// @param values  name to bare value
Answer results_answer(const Json& values, bool raw, const Incoming& request) {
  if (raw && values.size() == 1) return raw_answer(values.begin().value());
  if (raw && values.size() > 1 && accepts_multipart(request.header("accept"))) return multipart_answer(values);
  return json_answer(document_of(values));
}

bool prefers_async(const Incoming& request) {
  for (const std::string& preference : split(request.header("prefer"), ','))
    if (lower(trimmed(preference.substr(0, preference.find(';')))) == "respond-async") return true;
  return false;
}

/// No type at all counts as JSON.
bool is_json(const std::string& content_type) {
  const std::string type = lower(trimmed(std::string_view(content_type).substr(0, content_type.find(';'))));
  return type.empty() || type == "application/json" || (type.starts_with("application/") && type.ends_with("+json"));
}

/// The body of a request for any process, whose outputs are `known`.
Submission read_submission(const Exchange& exchange, const std::vector<std::string>& known) {
  const Incoming& incoming = exchange.request;
  if (!is_json(incoming.header("content-type")))
    throw Refusal(reason::unsupported_media_type, "send the body as Content-Type: application/json");
  const Json body = parse_body(incoming.body);
  Faults faults;
  Submission submission{.caller = exchange.caller()};
  if (!body.is_object()) throw Refusal(reason::bad_request, "the request body is invalid", {{"", "must be an object"}});
  if (body.contains("inputs") && !body.at("inputs").is_object())
    faults.add("/inputs", "must be an object");
  else if (body.contains("inputs"))
    submission.inputs = body.at("inputs");
  submission.outputs = read_outputs(body, known, faults);
  if (body.contains("response") && body.at("response") != "raw" && body.at("response") != "document")
    faults.add("/response", "must be \"raw\" or \"document\"");
  if (body.contains("subscriber"))
    faults.add("/subscriber", "callbacks are not supported; poll the job or use its events");
  refuse_if_any(faults, reason::bad_request, "the request body is invalid");
  submission.raw = body.contains("response") && body.at("response") == "raw";
  return submission;
}

using Submit = std::optional<Job> (Jobs::*)(const Submission&, const Store::Response&);

Answer submit(Exchange& exchange, Submit submit_job, const Submission& submission) {
  if (auto again = stored_answer(exchange)) return *again;
  const std::optional<Job> job = (exchange.service.jobs.*submit_job)(submission, response_to_store(exchange, 201));
  if (!job) {  // the same key, at the same moment
    if (auto again = stored_answer(exchange)) return *again;
    throw Refusal(reason::conflict, "another request with this Idempotency-Key is still in progress; retry later");
  }
  Answer answer = changed(exchange, *job, 201);
  if (prefers_async(exchange.request)) answer.headers.emplace_back("Preference-Applied", "respond-async");
  return answer;
}

void wait(double seconds, const Exchange& exchange) {
  if (seconds <= 0.0) return;
  using Clock = std::chrono::steady_clock;
  const WaitingRequest waiting(exchange, "send Prefer: respond-async");
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  while (Clock::now() < end && !exchange.service.stopping() && !exchange.request.stop.stop_requested())
    std::this_thread::sleep_for(
        std::min<std::chrono::duration<double>>(std::chrono::milliseconds(50), end - Clock::now()));
}

Answer echo(Exchange& exchange) {
  Submission submission = read_submission(exchange, {"s", "x"});
  submission.inputs = read_echo_inputs(submission.inputs);
  if (prefers_async(exchange.request)) return submit(exchange, &Jobs::submit_echo, submission);
  const double pause = submission.inputs.value("pause", 0.0);
  if (pause > 0.0 && exchange.request.body.size() > large_body)
    throw Refusal(reason::bad_request, "the inputs are invalid",
                  {{"/inputs/pause", "needs Prefer: respond-async with a body of more than " +
                                         std::to_string(large_body >> 10) + " KiB"}});
  Answer answer = results_answer(echo_results(submission.inputs, submission.outputs), submission.raw, exchange.request);
  submission = {};  // only the answer is in memory while it waits
  wait(pause, exchange);
  return answer;
}

Answer execute(Exchange& exchange) {
  const std::string& process = exchange.captured[0];
  if (process == "influence-zone")
    return submit(exchange, &Jobs::submit_study, read_submission(exchange, {"histogram", "summary"}));
  throw Refusal(reason::no_such_process, "there is no process with this ID; GET /processes lists them");
}

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
  if (more) links.push_back(next_link(exchange, "after", jobs.back().number));
  return json_answer({{"jobs", all}, {"links", links}});
}

Answer results(Exchange& exchange) {
  const Job job = job_of(exchange);
  if (job.state == JobState::dismissed) throw Refusal(reason::job_dismissed, "the job was dismissed");
  if (job.state == JobState::failed) throw Refusal(reason::unprocessable, "the job failed: " + job.message);
  if (job.state != JobState::successful) throw Refusal(reason::result_not_ready, "the job is still running");
  const Json asked = Json::parse(job.inputs);
  const auto outputs = asked.at("outputs").get<std::vector<std::string>>();
  const bool raw = asked.value("raw", false);
  if (job.process == "echo") {
    const Json values = Json::parse(exchange.service.store.echo_inputs(job.number));
    return results_answer(echo_results(values, outputs), raw, exchange.request);
  }
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
  return {{"POST", "/processes/{}/execution", Role::submit, execute, Lane::production},
          {"POST", "/processes/echo/execution", Role::submit, echo, Lane::waiting},
          {"GET", "/jobs", Role::read, list_jobs},
          {"GET", "/jobs/{}", Role::read, [](Exchange& e) { return json_answer(status_info(job_of(e), e)); }},
          {"DELETE", "/jobs/{}", Role::submit, dismiss},
          {"GET", "/jobs/{}/results", Role::read, results}};
}

}  // namespace talus::service
