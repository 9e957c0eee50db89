#pragma once
// Shared state of the handlers (thread-safe), and the routes.

#include <atomic>
#include <functional>

#include "http/message.hpp"
#include "http/places.hpp"
#include "http/tokens.hpp"
#include "jobs/jobs.hpp"

namespace talus::service {

struct Service {
  const Config& config;
  Store& store;
  Jobs& jobs;
  Scheduler& scheduler;
  std::function<bool()> stopping;
  Places streams{};                                    ///< of waiting requests, see WaitingRequest
  std::atomic<std::int64_t> requests{0}, failures{0};  ///< all answered requests; those with 5xx
};

/// Counts a request that waits while this object exists.
class WaitingRequest {
 public:
  /// @throws Refusal unavailable, with advice, where --max-streams of them wait already, or --max-streams-each of the
  /// subject
  WaitingRequest(const Exchange& exchange, const std::string& advice);
  ~WaitingRequest() { service_.streams.give_back(subject_); }
  WaitingRequest(const WaitingRequest&) = delete;
  WaitingRequest& operator=(const WaitingRequest&) = delete;

 private:
  Service& service_;
  std::string subject_;
};

using Handler = Answer (*)(Exchange&);

struct Route {
  const char* method;
  const char* pattern;  ///< "/jobs/{}/results": {} stands for one segment
  Role role;            ///< minimum role of the token
  Handler handler;
  Lane lane = Lane::request;
};

using Routes = std::vector<Route>;

/// What a request asks for.
struct FoundRoute {
  const Route* route = nullptr;  ///< null: no such path or, with `allow`, not this method
  std::vector<std::string> captured = {};
  std::string allow = {};  ///< methods allowed on the path; empty: no such path
};
/// HEAD is answered by the handler of GET; of several routes that match, the last one counts. Path "*" is the server:
/// it allows what any path does, and has no handler.
FoundRoute find_route(const Routes& routes, const std::string& method, const std::string& path);

Routes discovery_routes();    ///< /, /conformance, /api, /processes
Routes job_routes();          ///< /processes/{}/execution, /jobs, /jobs/{}, /jobs/{}/results
Routes realization_routes();  ///< histogram, realizations, retry, extend
Routes event_routes();        ///< /jobs/{}/events
Routes operation_routes();    ///< /healthz, /readyz, /metrics
Routes umbridge_routes();     ///< /Info, /Evaluate, ...

/// The stages of a request before its body is read (token, route), and after (handler, problem, ETag, log line).
/// @param request  without its body
Admission admit(Incoming request, const Routes& routes, Service& service, const Tokens& tokens);

}  // namespace talus::service
