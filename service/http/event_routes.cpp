// /jobs/{id}/events: a stream of status infos (server-sent events), or, with ?wait=, one long poll.

#include <thread>

#include "http/lookup.hpp"
#include "http/text.hpp"

namespace talus::service {
namespace {

using Steady = std::chrono::steady_clock;

constexpr std::int64_t longest_wait = 60;           ///< of a long poll [s]
constexpr std::chrono::minutes longest_stream{60};  ///< then the client reconnects
constexpr std::chrono::milliseconds quiet{3000};    ///< then a comment is sent, to notice a client that is gone
constexpr const char* poll_instead = "poll GET /jobs/ID instead";
constexpr std::chrono::milliseconds pace{200};  ///< between two events

/// Waits until the job's version is above `seen`, or it has ended, or the time is up. @return the job as it is then
Job wait_for_change(const Exchange& exchange, std::int64_t seen, Steady::time_point until) {
  for (;;) {
    const std::uint64_t count = exchange.service.scheduler.changes().count();
    Job job = job_of(exchange);
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(until - Steady::now());
    const bool unwanted = exchange.request.stop.stop_requested() || exchange.service.stopping();
    if (job.version > seen || ended(job.state) || left.count() <= 0 || unwanted) return job;
    exchange.service.scheduler.changes().wait(count, std::min(left, std::chrono::milliseconds(500)));
  }
}

Answer long_poll(Exchange& exchange, std::int64_t seconds) {
  const std::int64_t seen =
      whole_number(exchange.request, "since", 0, std::int64_t{1} << 62).value_or(job_of(exchange).version);
  const WaitingRequest waiting(exchange, poll_instead);
  const Job job = wait_for_change(exchange, seen, Steady::now() + std::chrono::seconds(seconds));
  Json info = status_info(job, exchange);
  info["version"] = job.version;
  return json_answer(info);
}

std::string event_text(const Job& job, const Exchange& exchange) {
  return "id: " + std::to_string(job.version) + "\nevent: status\ndata: " + dump(status_info(job, exchange)) + "\n\n";
}

void stream(const Exchange& exchange, std::int64_t seen, const Sink& sink) {
  const Steady::time_point end = Steady::now() + longest_stream;
  for (bool first = true; Steady::now() < end && !exchange.service.stopping(); first = false) {
    const Job job = wait_for_change(exchange, seen, Steady::now() + quiet);
    const bool news = job.version > seen || (first && ended(job.state));
    if (!sink(news ? event_text(job, exchange) : ": keep-alive\n\n")) return;
    seen = std::max(seen, job.version);
    if (ended(job.state)) return;
    std::this_thread::sleep_for(pace);
  }
}

Answer events(Exchange& exchange) {
  only_parameters(exchange.request, {"wait", "since"});
  job_of(exchange);
  if (const auto seconds = whole_number(exchange.request, "wait", 0, longest_wait))
    return long_poll(exchange, *seconds);
  const std::int64_t seen = to_whole(exchange.request.header("last-event-id")).value_or(0);
  const auto waiting = std::make_shared<WaitingRequest>(exchange, poll_instead);
  Answer answer{.type = event_stream};
  if (exchange.request.method != "HEAD")
    answer.stream = [waiting, exchange, seen](const Sink& sink) {
      try {
        stream(exchange, seen, sink);
      } catch (const std::exception&) {  // the job is dismissed, or the queue cannot be read: the client reconnects
      }
    };
  return answer;
}

}  // namespace

WaitingRequest::WaitingRequest(const Exchange& exchange, const std::string& advice)
    : service_(exchange.service), subject_(exchange.subject) {
  const Config& config = service_.config;
  const int each = config.tokens.empty() ? config.streams : config.streams_each;
  if (!service_.streams.take(subject_, config.streams, each))
    throw Refusal(reason::unavailable, "too many requests are waiting; " + advice, {}, 10);
}

Routes event_routes() { return {{"GET", "/jobs/{}/events", Role::read, events, Lane::waiting}}; }

}  // namespace talus::service
