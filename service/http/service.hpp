#pragma once
// Shared state of the handlers (thread-safe), and the groups of routes.

#include <atomic>
#include <functional>

#include "http/router.hpp"
#include "http/tokens.hpp"
#include "jobs/jobs.hpp"

namespace talus::service {

struct Service {
  const Config& config;
  Store& store;
  Jobs& jobs;
  const Scheduler& scheduler;
  Changes& changes;
  std::function<bool()> stopping;
  std::atomic<int> streams{0};
  std::atomic<std::int64_t> requests{0}, failures{0};  ///< all answered requests; those with 5xx
};

void add_discovery_routes(Router& router);                      ///< /, /conformance, /api, /processes
void add_execution_routes(Router& router, Service& service);    ///< /processes/{}/execution
void add_job_routes(Router& router, Service& service);          ///< /jobs, /jobs/{}, /jobs/{}/results
void add_realization_routes(Router& router, Service& service);  ///< histogram, realizations, retry, extend
void add_event_routes(Router& router, Service& service);        ///< /jobs/{}/events
void add_operation_routes(Router& router, Service& service);    ///< /healthz, /readyz, /metrics
void add_umbridge_routes(Router& router, Service& service);     ///< /Info, /Evaluate, ...

/// All stages of a request: token, route, handler, problem, ETag, log line.
Answer answer(const Incoming& request, const Router& router, Service& service, const Tokens& tokens);

}  // namespace talus::service
