// /jobs, /jobs/{id}, /jobs/{id}/results

#include "http/echo.hpp"
#include "http/links.hpp"
#include "http/lookup.hpp"

namespace talus::service {
namespace {

constexpr int default_limit = 100, max_limit = 1000;

JobFilter filter_of(const Exchange& exchange) {
  const Incoming& request = exchange.request;
  only_parameters(request, {"limit", "status", "processID", "type", "after"});
  JobFilter filter{.subject = exchange.subject};
  filter.limit = static_cast<int>(whole_number(request, "limit", 1, 1'000'000).value_or(default_limit));
  filter.limit = std::min(filter.limit, max_limit);
  filter.before = whole_number(request, "after", 0, std::int64_t{1} << 62);
  const auto [first, last] = request.query.equal_range("status");
  for (auto at = first; at != last; ++at)
    for (const std::string& name : comma_list(at->second)) {
      const auto state = job_state(name);
      if (!state)
        throw Refusal(Reason::bad_request, "a query parameter is not right",
                      {{"?status", "must be accepted, running, successful, failed or dismissed"}});
      filter.states.push_back(*state);
    }
  const auto [begin, end] = request.query.equal_range("processID");
  for (auto at = begin; at != end; ++at)
    for (const std::string& name : comma_list(at->second)) filter.processes.push_back(name);
  if (const auto type = request.parameter("type"); type && *type != "process")
    throw Refusal(Reason::bad_request, "a query parameter is not right", {{"?type", "must be process"}});
  return filter;
}

/// The text of a query again, less `after`.
std::string query_text(const Incoming& request) {
  std::string text;
  for (const auto& [name, value] : request.query)
    if (name != "after" && value.find_first_of("&#%+ \"<>") == std::string::npos) text += name + "=" + value + "&";
  return text;
}

Answer list(Exchange& exchange, Service& service) {
  JobFilter filter = filter_of(exchange);
  const auto limit = static_cast<std::size_t>(filter.limit++);  // one more, to see whether there is more
  std::vector<Job> jobs = service.store.jobs(filter);
  const bool more = jobs.size() > limit;
  if (more) jobs.resize(limit);
  Json all = Json::array(), links = {link(exchange, "/jobs", "self", "Jobs")};
  for (const Job& job : jobs) all.push_back(status_info(job, exchange));
  if (more)
    links.push_back(link(exchange, "/jobs?" + query_text(exchange.request) + "after=" + std::to_string(jobs.back().number),
                         "next", "The next jobs"));
  return json_answer({{"jobs", all}, {"links", links}});
}

/// An object can only stand in a results document as a qualified value.
Json qualified(Json value) { return {{"value", std::move(value)}, {"mediaType", "application/json"}}; }

Answer results(Exchange& exchange, Service& service) {
  const Job job = job_of(exchange, service);
  if (job.state == JobState::dismissed) throw Refusal(Reason::job_dismissed, "the job was dismissed");
  if (job.state == JobState::failed) throw Refusal(Reason::unprocessable, "the job failed: " + job.message);
  if (job.state != JobState::successful) throw Refusal(Reason::result_not_ready, "the job has not ended yet");
  const Json asked = Json::parse(job.inputs);
  const auto outputs = asked.at("outputs").get<std::vector<std::string>>();
  if (job.process == "echo") return json_answer(echo_results(asked.at("inputs"), outputs));
  Json document = Json::object();
  for (const std::string& output : outputs) {
    if (output == "summary") document[output] = qualified(service.jobs.summary(job));
    if (output == "histogram")
      document[output] = qualified(service.jobs.distribution(job, quantity_index(asked.at("quantity"), ""), {}, {}));
  }
  return json_answer(document);
}

Answer dismiss(Exchange& exchange, Service& service) {
  const Job job = job_of(exchange, service);
  service.jobs.dismiss(job);
  return json_answer(status_info(*service.store.job(job.id), exchange));
}

}  // namespace

void add_job_routes(Router& router, Service& service) {
  router.add("GET", "/jobs", Role::read, [&service](Exchange& e) { return list(e, service); });
  router.add("GET", "/jobs/{}", Role::read,
             [&service](Exchange& e) { return json_answer(status_info(job_of(e, service), e)); });
  router.add("DELETE", "/jobs/{}", Role::submit, [&service](Exchange& e) { return dismiss(e, service); });
  router.add("GET", "/jobs/{}/results", Role::read, [&service](Exchange& e) { return results(e, service); });
}

}  // namespace talus::service
