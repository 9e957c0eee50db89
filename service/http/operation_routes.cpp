// For the operator: liveness, readiness, metrics.

#include "http/service.hpp"
#include "jobs/orphans.hpp"
#include "support/files.hpp"

namespace talus::service {
namespace {

Answer healthy(Exchange&) { return json_answer({{"status", "ok"}}); }

Answer ready(Exchange& exchange) {
  const Service& service = exchange.service;
  service.store.open_jobs({});  // throws when the queue cannot be read
  if (service.stopping()) throw Refusal(reason::unavailable, "talusd is stopping");
  if (disk_left(service.config.data) < service.config.quotas.disk_bytes)
    throw Refusal(reason::unavailable, "the disk has less free space than --min-disk requires");
  Json status = {{"status", "ready"}};
  if (const std::size_t orphans = count_orphans({service.config.data}); orphans > 0) {
    status["orphans"] = orphans;
    status["detail"] = "DATA/orphans holds what the queue does not know; stop talusd and take it back with --adopt";
  }
  return json_answer(status);
}

/// One sample of a metric: what follows the name of its family, and the value.
struct Sample {
  std::string suffix;  ///< "", "_sum" or {labels}
  double value;
};

/// A family of metrics in the text format of Prometheus.
std::string family(const std::string& name, const char* type, const char* help, const std::vector<Sample>& samples) {
  std::string text = "# HELP " + name + " " + help + "\n# TYPE " + name + " " + type + "\n";
  for (const Sample& sample : samples) text += name + sample.suffix + " " + Json(sample.value).dump() + "\n";
  return text;
}

std::string label(const std::string& name, const std::string& value) { return "{" + name + "=\"" + value + "\"}"; }

Answer metrics(Exchange& exchange) {
  using Kind = RunEvent::Kind;
  const Service& service = exchange.service;
  const StateCounts counts = service.store.state_counts();
  const RunCounters& runs = service.scheduler.counters();
  const auto ended = [&](Kind kind) { return static_cast<double>(runs.ended[static_cast<std::size_t>(kind)]); };
  const double done = ended(Kind::done) + ended(Kind::taken_over);
  std::vector<Sample> jobs;
  for (std::size_t i = 0; i < counts.jobs.size(); ++i)
    jobs.push_back({label("status", job_words[i]), static_cast<double>(counts.jobs[i])});
  const auto queued = static_cast<double>(counts.runs[static_cast<std::size_t>(RunState::queued)]);
  return {.type = "text/plain; version=0.0.4",
          .body = family("talus_jobs", "gauge", "Jobs by status.", jobs) +
                  family("talus_queue_depth", "gauge", "Runs waiting for a worker.", {{"", queued}}) +
                  family("talus_workers", "gauge", "Workers.",
                         {{label("state", "all"), static_cast<double>(service.config.workers)},
                          {label("state", "busy"), static_cast<double>(runs.running)}}) +
                  family("talus_realizations_total", "counter", "Runs ended since talusd started, by outcome.",
                         {{label("outcome", "done"), done},
                          {label("outcome", "failed"), ended(Kind::failed)},
                          {label("outcome", "crashed_and_requeued"), ended(Kind::crashed)},
                          {label("outcome", "given_back"), ended(Kind::given_back)},
                          {label("outcome", "stale"), ended(Kind::stale)}}) +
                  family("talus_realization_seconds", "summary", "Wall-clock time of successful runs.",
                         {{"_sum", static_cast<double>(runs.wall_clock_ms) / 1000.0}, {"_count", done}}) +
                  family("talus_orphans", "gauge", "Entries of DATA/orphans: what the queue does not know.",
                         {{"", static_cast<double>(count_orphans({service.config.data}))}}) +
                  family("talus_disk_left_bytes", "gauge", "Free disk space of the data directory.",
                         {{"", static_cast<double>(disk_left(service.config.data))}}) +
                  family("talus_http_requests_total", "counter", "Requests answered.",
                         {{"", static_cast<double>(service.requests)}}) +
                  family("talus_http_failures_total", "counter", "Requests answered with 5xx.",
                         {{"", static_cast<double>(service.failures)}}) +
                  family("talus_event_streams", "gauge", "Open event streams.",
                         {{"", static_cast<double>(service.streams.taken())}})};
}

}  // namespace

Routes operation_routes() {
  return {{"GET", "/healthz", Role::none, healthy, Lane::immediate},
          {"GET", "/readyz", Role::none, ready, Lane::operation},
          {"GET", "/metrics", Role::read, metrics, Lane::operation}};
}

}  // namespace talus::service
