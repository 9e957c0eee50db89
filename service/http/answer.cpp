// From a request to its answer: token, route, handler, problem, ETag, log line.

#include <cerrno>
#include <chrono>
#include <cmath>
#include <filesystem>

#include "base/digest.hpp"
#include "http/service.hpp"
#include "http/text.hpp"
#include "support/files.hpp"

namespace talus::service {
namespace {

std::vector<std::string> segments_of(const std::string& path) {
  std::vector<std::string> all = split(path.substr(std::min<std::size_t>(1, path.size())), '/');
  if (all.size() > 1 && all.back().empty()) all.pop_back();  // "/jobs/" is "/jobs"
  return all;
}

bool matches(const std::vector<std::string>& pattern, const std::vector<std::string>& path,
             std::vector<std::string>& captured) {
  if (pattern.size() != path.size()) return false;
  captured.clear();
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (pattern[i] == "{}")
      captured.push_back(path[i]);
    else if (pattern[i] != path[i])
      return false;
  }
  return true;
}

/// Paths that need no token: they reveal nothing of any job.
bool is_open(const std::string& path) { return path == "/healthz" || path == "/readyz"; }

/// "http://host:port" before the path of absolute links.
std::string base_of(const Incoming& request, const Config& config) {
  if (!config.public_url.empty()) return config.public_url;
  const std::string scheme = request.header("x-forwarded-proto") == "https" ? "https" : "http";
  const std::string host = request.header("host");
  return scheme + "://" + (host.empty() ? config.address + ":" + std::to_string(config.port) : host);
}

/// The route of a request. @throws Refusal where the token or the role does not suffice, or there is no such route
FoundRoute route_of(const Exchange& exchange, const Routes& routes) {
  const Incoming& request = exchange.request;
  if (exchange.role == Role::none && !is_open(request.path))
    throw Refusal(reason::unauthorized, "send an Authorization: Bearer header with a valid token");
  FoundRoute found = find_route(routes, request.method, request.path);
  if (found.allow.empty()) throw Refusal(reason::not_found, "no resource exists at this path");
  if (request.method == "OPTIONS") return found;
  if (!found.route) {
    Refusal refusal(reason::method_not_allowed, request.method + " is not allowed on this path");
    refusal.allow = found.allow;
    throw refusal;
  }
  if (found.route->role > exchange.role)
    throw Refusal(reason::forbidden, "this token has the role read; submitting needs a token with the role submit");
  return found;
}

/// Adds the entity tag; the answer to a client that has this version is 304 (RFC 9110 13.1.2, weak comparison).
void add_tag(Answer& answer, const Incoming& request) {
  if ((request.method != "GET" && request.method != "HEAD") || answer.status != 200 || answer.type == event_stream)
    return;
  const std::string tag = '"' + sha256(answer.body).substr(0, 24) + '"', known = request.header("if-none-match");
  answer.headers.emplace_back("ETag", tag);
  answer.headers.emplace_back("Cache-Control", "no-cache");
  if (known != "*" && known.find(tag) == std::string::npos) return;
  answer.status = 304;
  answer.body.clear();
}

/// The client's X-Request-Id where it is harmless in a log, otherwise a new one.
std::string request_id(const Incoming& request) {
  const std::string given = request.header("x-request-id");
  return is_identifier(given, "-_.") ? given : random_hex(8);
}

/// How long a client may wait for its answer.
std::chrono::seconds limit_of(Lane lane, const Config& config) {
  if (lane == Lane::waiting) return std::chrono::hours(2) + 2 * config.time_limit;  // longer than any of them waits
  return std::chrono::seconds(lane == Lane::production ? 240 : 120);  // production: two commands, and waiting for both
}

/// Counts and logs an answer. @return the answer, with the id under which the log has it
Answer completed(const Exchange& exchange, Answer answer, std::chrono::steady_clock::time_point begin) {
  const std::string id = request_id(exchange.request);
  answer.headers.emplace_back("X-Request-Id", id);
  ++exchange.service.requests;
  if (answer.status >= 500) ++exchange.service.failures;
  const std::chrono::duration<double, std::milli> duration = std::chrono::steady_clock::now() - begin;
  if (!is_open(exchange.request.path))
    log_info("request", {{"request_id", id},
                         {"subject", exchange.subject},
                         {"method", exchange.request.method},
                         {"path", exchange.request.path},
                         {"status", answer.status},
                         {"ms", std::round(1000.0 * duration.count()) / 1000.0}});
  return answer;
}

Answer file_problem(int error, const char* what, const std::string& accept) {
  log_error("files", {{"why", what}});
  if (error == ENOSPC || error == EDQUOT) return problem(Refusal(reason::disk_full, "the disk is full"), accept);
  return problem(Refusal(reason::unavailable, "the service cannot read or write one of its files"), accept);
}

}  // namespace

FoundRoute find_route(const Routes& routes, const std::string& method, const std::string& path) {
  FoundRoute found;
  const std::vector<std::string> segments = segments_of(path);
  for (const Route& route : routes) {
    std::vector<std::string> captured;
    const std::string known = route.method;
    if (path != "*" && !matches(segments_of(route.pattern), segments, captured)) continue;
    if (found.allow.find(known) == std::string::npos)
      found.allow += (found.allow.empty() ? "" : ", ") + known + (known == "GET" ? ", HEAD" : "");
    if (path == "*" || (known != method && !(known == "GET" && method == "HEAD"))) continue;
    found.route = &route;
    found.captured = std::move(captured);
  }
  if (!found.allow.empty()) found.allow += ", OPTIONS";
  return found;
}

Admission admit(Incoming request, const Routes& routes, Service& service, const Tokens& tokens) {
  const auto begin = std::chrono::steady_clock::now();
  const auto exchange = std::make_shared<Exchange>(Exchange{.service = service, .request = std::move(request)});
  exchange->base = base_of(exchange->request, service.config);
  if (tokens.wanted()) {
    const auto bearer = tokens.find(exchange->request.header("authorization")).value_or(Bearer{"", Role::none});
    exchange->subject = bearer.subject;
    exchange->role = bearer.role;
  }
  Admission admission{.subject = exchange->subject};
  try {
    FoundRoute found = route_of(*exchange, routes);
    if (!found.route || exchange->request.method == "OPTIONS") {
      admission.refusal = completed(*exchange, {.status = 204, .headers = {{"Allow", found.allow}}}, begin);
      return admission;
    }
    exchange->captured = std::move(found.captured);
    admission.lane = found.route->lane;
    admission.limit = limit_of(found.route->lane, service.config);
    admission.handle = [exchange, handler = found.route->handler, begin](std::string body, std::stop_token stop) {
      exchange->request.body = std::move(body);
      exchange->request.stop = std::move(stop);
      Answer answer;
      try {
        answer = handler(*exchange);
        add_tag(answer, exchange->request);
      } catch (...) {
        answer = problem(std::current_exception(), exchange->request.header("accept"));
      }
      return completed(*exchange, std::move(answer), begin);
    };
  } catch (const Refusal& refusal) {
    admission.refusal = completed(*exchange, problem(refusal, exchange->request.header("accept")), begin);
  }
  return admission;
}

Answer problem(const Refusal& refusal, const std::string& accept) {
  const Reason& reason = refusal.reason;
  Json body = {{"type", reason.type}, {"title", reason.title}, {"status", reason.status}, {"detail", refusal.what()}};
  for (const Fault& fault : refusal.faults)
    body["errors"].push_back({{"pointer", fault.pointer}, {"message", fault.message}});
  Answer answer = json_answer(body, reason.status);
  if (accept.find("application/problem+json") != std::string::npos) answer.type = "application/problem+json";
  if (!refusal.allow.empty()) answer.headers.emplace_back("Allow", refusal.allow);
  if (reason == reason::unauthorized) answer.headers.emplace_back("WWW-Authenticate", "Bearer, Basic realm=\"talusd\"");
  if (refusal.retry_after) answer.headers.emplace_back("Retry-After", std::to_string(*refusal.retry_after));
  return answer;
}

Answer problem(std::exception_ptr thrown, const std::string& accept) {
  try {
    std::rethrow_exception(thrown);
  } catch (const Refusal& e) {
    return problem(e, accept);
  } catch (const StorageError& e) {
    log_error("storage", {{"why", e.what()}});
    return problem(Refusal(e.disk_full ? reason::disk_full : reason::unavailable, e.what(), {}, 30), accept);
  } catch (const IoError& e) {
    return file_problem(e.error, e.what(), accept);
  } catch (const std::filesystem::filesystem_error& e) {
    return file_problem(e.code().value(), e.what(), accept);
  } catch (const std::exception& e) {
    log_error("internal", {{"why", e.what()}});
    return problem(Refusal(reason::internal, "internal error; details are in the log of talusd"), accept);
  }
}

}  // namespace talus::service
