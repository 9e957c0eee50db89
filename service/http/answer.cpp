#include <chrono>

#include "base/digest.hpp"
#include "base/log.hpp"
#include "http/problem.hpp"
#include "http/service.hpp"

namespace talus::service {
namespace {

/// Those that say nothing about anybody's work.
bool is_open(const std::string& path) { return path == "/healthz" || path == "/readyz"; }

/// "http://host:port" in front of absolute links.
std::string base_of(const Incoming& request, const Config& config) {
  if (!config.public_url.empty()) return config.public_url;
  const std::string scheme = request.header("x-forwarded-proto") == "https" ? "https" : "http";
  const std::string host = request.header("host");
  return scheme + "://" + (host.empty() ? config.address + ":" + std::to_string(config.port) : host);
}

void identify(Exchange& exchange, const Tokens& tokens) {
  if (!tokens.wanted()) return;
  const auto bearer = tokens.find(exchange.request.header("authorization"));
  exchange.subject = bearer ? bearer->subject : "";
  exchange.role = bearer ? bearer->role : Role::none;
}

Answer routed(Exchange& exchange, const Router& router) {
  const Incoming& request = exchange.request;
  if (exchange.role == Role::none && !is_open(request.path))
    throw Refusal(Reason::unauthorized, "send an Authorization: Bearer header with a valid token");
  Router::Found found = router.find(request.method, request.path);
  if (found.allow.empty()) throw Refusal(Reason::not_found, "no resource exists at this path");
  if (request.method == "OPTIONS") return {.status = 204, .headers = {{"Allow", found.allow}}};
  if (!found.handler) {
    Refusal refusal(Reason::method_not_allowed, request.method + " is not allowed on this path");
    refusal.allow = found.allow;
    throw refusal;
  }
  if (found.role > exchange.role)
    throw Refusal(Reason::forbidden, "this token has the role read; submitting needs a token with the role submit");
  exchange.captured = std::move(found.captured);
  return (*found.handler)(exchange);
}

/// RFC 9110 13.1.2, for weak and strong tags alike.
bool matches(const std::string& if_none_match, const std::string& tag) {
  return if_none_match == "*" || if_none_match.find(tag) != std::string::npos;
}

void tag(Answer& answer, const Incoming& request) {
  if ((request.method != "GET" && request.method != "HEAD") || answer.status != 200 || answer.type == event_stream)
    return;
  const std::string etag = '"' + sha256(answer.body).substr(0, 24) + '"';
  answer.headers.emplace_back("ETag", etag);
  answer.headers.emplace_back("Cache-Control", "no-cache");
  if (!matches(request.header("if-none-match"), etag)) return;
  answer.status = 304;
  answer.body.clear();
}

/// What a client calls its request, if it is fit for a log; else a new one.
std::string request_id(const Incoming& request) {
  const std::string given = request.header("x-request-id");
  const bool fit =
      !given.empty() && given.size() <= 64 &&
      given.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.") == std::string::npos;
  return fit ? given : random_hex(8);
}

}  // namespace

Answer answer(const Incoming& request, const Router& router, Service& service, const Tokens& tokens) {
  const auto begin = std::chrono::steady_clock::now();
  Exchange exchange{.request = request, .base = base_of(request, service.config)};
  Answer answer;
  try {
    identify(exchange, tokens);
    answer = routed(exchange, router);
    tag(answer, request);
  } catch (...) {
    answer = problem(std::current_exception(), request.header("accept"));
  }
  const std::string id = request_id(request);
  answer.headers.emplace_back("X-Request-Id", id);
  ++service.requests;
  if (answer.status >= 500) ++service.failures;
  const auto ms =
      std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() - begin).count() / 1000.0;
  if (!is_open(request.path))
    log_info("request", {{"request_id", id},
                         {"subject", exchange.subject},
                         {"method", request.method},
                         {"path", request.path},
                         {"status", answer.status},
                         {"ms", ms}});
  return answer;
}

}  // namespace talus::service
