// /jobs/{id}/events: a stream of status infos (server-sent events), or, with ?wait=, one long poll.

#include <thread>

#include "http/links.hpp"
#include "http/lookup.hpp"

namespace talus::service {
namespace {

using Steady = std::chrono::steady_clock;

constexpr std::int64_t longest_wait = 60;           ///< of a long poll [s]
constexpr std::chrono::minutes longest_stream{60};  ///< then the client reconnects by itself
constexpr std::chrono::milliseconds quiet{3000};    ///< then a comment shows whether the client is there
constexpr std::chrono::milliseconds pace{200};      ///< at most so often

/// A place among the requests that wait.
class Place {
 public:
  explicit Place(Service& service) : service_(service) {
    if (++service_.streams <= service_.config.streams) return;
    --service_.streams;
    Refusal full(Reason::unavailable, "too many event streams are open; poll GET /jobs/ID instead");
    full.retry_after = 10;
    throw full;
  }
  ~Place() { --service_.streams; }
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;

 private:
  Service& service_;
};

/// Waits until the job's version is above `seen`, or it has ended, or the time is up. @return the job as it is then
Job wait_for_change(const Exchange& exchange, Service& service, std::int64_t seen, Steady::time_point until) {
  for (;;) {
    const std::uint64_t count = service.changes.count();
    Job job = job_of(exchange, service);
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(until - Steady::now());
    if (job.version > seen || ended(job.state) || left.count() <= 0 || service.stopping()) return job;
    service.changes.wait(count, std::min(left, std::chrono::milliseconds(500)));
  }
}

Answer long_poll(Exchange& exchange, Service& service, std::int64_t seconds) {
  const std::int64_t seen =
      whole_number(exchange.request, "since", 0, std::int64_t{1} << 62).value_or(job_of(exchange, service).version);
  const Place place(service);
  const Job job = wait_for_change(exchange, service, seen, Steady::now() + std::chrono::seconds(seconds));
  Json info = status_info(job, exchange);
  info["version"] = job.version;
  return json_answer(info);
}

std::string event_text(const Job& job, const Exchange& exchange) {
  return "id: " + std::to_string(job.version) + "\nevent: status\ndata: " + dump(status_info(job, exchange)) + "\n\n";
}

void stream(const Exchange& exchange, Service& service, std::int64_t seen, const Sink& sink) {
  const Steady::time_point end = Steady::now() + longest_stream;
  for (bool first = true; Steady::now() < end && !service.stopping(); first = false) {
    const Job job = wait_for_change(exchange, service, seen, Steady::now() + quiet);
    const bool news = job.version > seen || (first && ended(job.state));
    if (!sink(news ? event_text(job, exchange) : ": keep-alive\n\n")) return;
    seen = std::max(seen, job.version);
    if (ended(job.state)) return;
    std::this_thread::sleep_for(pace);
  }
}

Answer events(Exchange& exchange, Service& service) {
  only_parameters(exchange.request, {"wait", "since"});
  job_of(exchange, service);
  if (const auto seconds = whole_number(exchange.request, "wait", 0, longest_wait))
    return long_poll(exchange, service, *seconds);
  std::int64_t seen = 0;
  const std::string last = exchange.request.header("last-event-id");
  if (last.size() <= 18 && last.find_first_not_of("0123456789") == std::string::npos && !last.empty())
    seen = std::stoll(last);
  // The exchange's request is gone when the stream runs: it gets a copy.
  const auto place = std::make_shared<Place>(service);
  const auto request = std::make_shared<Incoming>(exchange.request);
  Answer answer{.type = event_stream};
  answer.stream = [&service, place, request, captured = exchange.captured, subject = exchange.subject,
                   role = exchange.role, base = exchange.base, seen](const Sink& sink) {
    const Exchange copy{.request = *request, .captured = captured, .subject = subject, .role = role, .base = base};
    try {
      stream(copy, service, seen, sink);
    } catch (const std::exception&) {  // the job is gone, or the queue cannot be read: the client asks again
    }
  };
  if (exchange.request.method == "HEAD") answer.stream = nullptr;
  return answer;
}

}  // namespace

void add_event_routes(Router& router, Service& service) {
  router.add("GET", "/jobs/{}/events", Role::read, [&service](Exchange& e) { return events(e, service); });
}

}  // namespace talus::service
