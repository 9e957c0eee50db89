// For the operator: liveness, readiness, metrics.

#include "http/service.hpp"
#include "support/files.hpp"

namespace talus::service {
namespace {

Answer healthy(Exchange&) { return json_answer({{"status", "ok"}}); }

Answer ready(Service& service) {
  service.store.open_jobs({});  // throws when the queue cannot be read
  if (service.stopping()) throw Refusal(Reason::unavailable, "talusd is stopping");
  if (disk_left(service.config.data) < service.config.quotas.disk_bytes)
    throw Refusal(Reason::unavailable, "the disk has less free space than --min-disk requires");
  return json_answer({{"status", "ready"}});
}

/// The text format of Prometheus.
class Metrics {
 public:
  void family(const char* name, const char* type, const char* help) {
    text_ += std::string("# HELP ") + name + " " + help + "\n# TYPE " + name + " " + type + "\n";
    name_ = name;
  }
  void value(double value, const std::string& labels = {}) {
    text_ += name_ + (labels.empty() ? "" : "{" + labels + "}") + " " + Json(value).dump() + "\n";
  }
  void part(const std::string& suffix, double value) { text_ += name_ + suffix + " " + Json(value).dump() + "\n"; }
  const std::string& text() const { return text_; }

 private:
  std::string text_, name_;
};

Answer metrics(Service& service) {
  const Census census = service.store.census();
  const WorkDone& done = service.scheduler.work_done();
  Metrics m;
  m.family("talus_jobs", "gauge", "Jobs by status.");
  for (int i = 0; i < 5; ++i)
    m.value(static_cast<double>(census.jobs[static_cast<std::size_t>(i)]),
            std::string("status=\"") + word(static_cast<JobState>(i)) + "\"");
  m.family("talus_queue_depth", "gauge", "Runs waiting for a worker.");
  m.value(static_cast<double>(census.runs[static_cast<std::size_t>(RunState::queued)]));
  m.family("talus_workers", "gauge", "Workers.");
  m.value(service.config.workers, "state=\"all\"");
  m.value(done.running, "state=\"busy\"");
  m.family("talus_realizations_total", "counter", "Runs ended since talusd started, by outcome.");
  m.value(static_cast<double>(done.done), "outcome=\"done\"");
  m.value(static_cast<double>(done.failed), "outcome=\"failed\"");
  m.value(static_cast<double>(done.crashed), "outcome=\"crashed_and_requeued\"");
  m.value(static_cast<double>(done.given_back), "outcome=\"given_back\"");
  m.value(static_cast<double>(done.stale), "outcome=\"stale\"");
  m.family("talus_realization_seconds", "summary", "Wall-clock time of successful runs.");
  m.part("_sum", static_cast<double>(done.wall_clock_ms) / 1000.0);
  m.part("_count", static_cast<double>(done.done));
  m.family("talus_orphans", "gauge", "Directories of unknown jobs that were moved to DATA/orphans at start.");
  m.value(done.orphans);
  m.family("talus_disk_left_bytes", "gauge", "Free disk space of the data directory.");
  m.value(static_cast<double>(disk_left(service.config.data)));
  m.family("talus_http_requests_total", "counter", "Requests answered.");
  m.value(static_cast<double>(service.requests));
  m.family("talus_http_failures_total", "counter", "Requests answered with 5xx.");
  m.value(static_cast<double>(service.failures));
  m.family("talus_event_streams", "gauge", "Open event streams.");
  m.value(service.streams);
  return {.type = "text/plain; version=0.0.4", .body = m.text()};
}

}  // namespace

void add_operation_routes(Router& router, Service& service) {
  router.add("GET", "/healthz", Role::none, healthy);
  router.add("GET", "/readyz", Role::none, [&service](Exchange&) { return ready(service); });
  router.add("GET", "/metrics", Role::read, [&service](Exchange&) { return metrics(service); });
}

}  // namespace talus::service
