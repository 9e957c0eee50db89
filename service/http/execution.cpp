// POST /processes/{id}/execution

#include <thread>

#include "http/echo.hpp"
#include "http/links.hpp"
#include "http/lookup.hpp"
#include "http/results.hpp"

namespace talus::service {
namespace {

std::string lower_trimmed(std::string text) {
  const auto begin = text.find_first_not_of(" \t"), end = text.find_last_not_of(" \t");
  text = begin == std::string::npos ? "" : text.substr(begin, end - begin + 1);
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

bool prefers_async(const Incoming& request) {
  for (const std::string& preference : comma_list(request.header("prefer")))
    if (lower_trimmed(preference.substr(0, preference.find(';'))) == "respond-async") return true;
  return false;
}

/// What may be asked for, whatever the process.
struct Request {
  Json inputs = Json::object();
  std::vector<std::string> outputs;
  bool raw = false;
};

Request read_request(const Incoming& incoming, const std::vector<std::string>& known) {
  const std::string type = lower_trimmed(incoming.header("content-type"));
  if (!type.empty() && type.find("json") == std::string::npos)
    throw Refusal(Reason::unsupported_media_type, "send the body as Content-Type: application/json");
  const Json body = parse_body(incoming.body);
  Checker check;
  Request request;
  if (!body.is_object()) throw Refusal(Reason::bad_request, "the request body is invalid", {{"", "must be an object"}});
  if (body.contains("inputs") && !body.at("inputs").is_object())
    check.fault("/inputs", "must be an object");
  else if (body.contains("inputs"))
    request.inputs = body.at("inputs");
  request.outputs = read_outputs(body, known, check);
  if (body.contains("response") && body.at("response") != "raw" && body.at("response") != "document")
    check.fault("/response", "must be \"raw\" or \"document\"");
  if (body.contains("subscriber"))
    check.fault("/subscriber", "callbacks are not supported; poll the job or use its events");
  check.finish(Reason::bad_request, "the request body is invalid");
  request.raw = body.contains("response") && body.at("response") == "raw";
  return request;
}

Answer accepted(Exchange& exchange, Service& service,
                const std::function<std::optional<Job>(const Store::Answer&)>& submit) {
  if (auto again = told_before(exchange, service)) return *again;
  const std::optional<Job> job = submit(keeping(exchange, 201, true));
  if (!job) {  // the same key, at the same moment
    if (auto again = told_before(exchange, service)) return *again;
    throw Refusal(Reason::conflict, "another request with this Idempotency-Key is still in progress; retry later");
  }
  Answer answer = changed(exchange, *job, 201, true);
  if (prefers_async(exchange.request)) answer.headers.emplace_back("Preference-Applied", "respond-async");
  return answer;
}

Answer study(Exchange& exchange, Service& service) {
  const Request request = read_request(exchange.request, {"histogram", "summary"});
  return accepted(exchange, service, [&](const Store::Answer& keep) {
    return service.jobs.submit_study(exchange.subject, request.inputs, request.outputs, request.raw, keep);
  });
}

void wait(double seconds, Service& service) {
  if (seconds <= 0.0) return;
  if (++service.streams > service.config.streams) {
    --service.streams;
    throw Refusal(Reason::unavailable, "too many synchronous requests are waiting; send Prefer: respond-async");
  }
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (std::chrono::steady_clock::now() < end && !service.stopping())
    std::this_thread::sleep_for(
        std::min<std::chrono::duration<double>>(std::chrono::milliseconds(50), end - std::chrono::steady_clock::now()));
  --service.streams;
}

Answer echo(Exchange& exchange, Service& service) {
  const Request request = read_request(exchange.request, {"s", "x"});
  const Json inputs = read_echo_inputs(request.inputs);
  if (prefers_async(exchange.request))
    return accepted(exchange, service, [&](const Store::Answer& keep) {
      return service.jobs.submit_echo(exchange.subject, inputs, request.outputs, request.raw, keep);
    });
  wait(inputs.value("pause", 0.0), service);
  return results_answer(echo_results(inputs, request.outputs), request.raw, exchange.request);
}

}  // namespace

void add_execution_routes(Router& router, Service& service) {
  router.add("POST", "/processes/{}/execution", Role::submit, [&service](Exchange& exchange) {
    const std::string& process = exchange.captured[0];
    if (process == "influence-zone") return study(exchange, service);
    if (process == "echo") return echo(exchange, service);
    throw Refusal(Reason::no_such_process, "there is no process with this ID; GET /processes lists them");
  });
}

}  // namespace talus::service
