// POST /processes/{id}/execution

#include <thread>

#include "http/lookup.hpp"
#include "http/results.hpp"
#include "http/text.hpp"

namespace talus::service {
namespace {

bool prefers_async(const Incoming& request) {
  for (const std::string& preference : split(request.header("prefer"), ','))
    if (lower(trimmed(preference.substr(0, preference.find(';')))) == "respond-async") return true;
  return false;
}

/// The body of a request for any process.
struct Request {
  Json inputs = Json::object();
  std::vector<std::string> outputs;
  bool raw = false;
};

Request read_request(const Incoming& incoming, const std::vector<std::string>& known) {
  const std::string type = lower(incoming.header("content-type"));
  if (!type.empty() && type.find("json") == std::string::npos)
    throw Refusal(Reason::unsupported_media_type, "send the body as Content-Type: application/json");
  const Json body = parse_body(incoming.body);
  Faults faults;
  Request request;
  if (!body.is_object()) throw Refusal(Reason::bad_request, "the request body is invalid", {{"", "must be an object"}});
  if (body.contains("inputs") && !body.at("inputs").is_object())
    faults.add("/inputs", "must be an object");
  else if (body.contains("inputs"))
    request.inputs = body.at("inputs");
  request.outputs = read_outputs(body, known, faults);
  if (body.contains("response") && body.at("response") != "raw" && body.at("response") != "document")
    faults.add("/response", "must be \"raw\" or \"document\"");
  if (body.contains("subscriber"))
    faults.add("/subscriber", "callbacks are not supported; poll the job or use its events");
  refuse_if_any(faults, Reason::bad_request, "the request body is invalid");
  request.raw = body.contains("response") && body.at("response") == "raw";
  return request;
}

Answer accepted(Exchange& exchange, const std::function<std::optional<Job>(const Store::Response&)>& submit) {
  if (auto again = stored_answer(exchange)) return *again;
  const std::optional<Job> job = submit(response_to_store(exchange, 201));
  if (!job) {  // the same key, at the same moment
    if (auto again = stored_answer(exchange)) return *again;
    throw Refusal(Reason::conflict, "another request with this Idempotency-Key is still in progress; retry later");
  }
  Answer answer = changed(exchange, *job, 201);
  if (prefers_async(exchange.request)) answer.headers.emplace_back("Preference-Applied", "respond-async");
  return answer;
}

Answer study(Exchange& exchange) {
  const Request request = read_request(exchange.request, {"histogram", "summary"});
  return accepted(exchange, [&](const Store::Response& keep) {
    return exchange.service.jobs.submit_study(exchange.subject, request.inputs, request.outputs, request.raw, keep);
  });
}

void wait(double seconds, Service& service) {
  if (seconds <= 0.0) return;
  using Clock = std::chrono::steady_clock;
  const WaitingRequest waiting(service);
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  while (Clock::now() < end && !service.stopping())
    std::this_thread::sleep_for(
        std::min<std::chrono::duration<double>>(std::chrono::milliseconds(50), end - Clock::now()));
}

Answer echo(Exchange& exchange) {
  const Request request = read_request(exchange.request, {"s", "x"});
  const Json inputs = read_echo_inputs(request.inputs);
  if (prefers_async(exchange.request))
    return accepted(exchange, [&](const Store::Response& keep) {
      return exchange.service.jobs.submit_echo(exchange.subject, inputs, request.outputs, request.raw, keep);
    });
  wait(inputs.value("pause", 0.0), exchange.service);
  return results_answer(echo_results(inputs, request.outputs), request.raw, exchange.request);
}

Answer execute(Exchange& exchange) {
  const std::string& process = exchange.captured[0];
  if (process == "influence-zone") return study(exchange);
  if (process == "echo") return echo(exchange);
  throw Refusal(Reason::no_such_process, "there is no process with this ID; GET /processes lists them");
}

}  // namespace

Routes execution_routes() { return {{"POST", "/processes/{}/execution", Role::submit, execute}}; }

}  // namespace talus::service
