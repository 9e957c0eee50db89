#pragma once
// Request and answer as the handlers see them, independent of the HTTP library.

#include <chrono>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "base/json.hpp"
#include "base/shares.hpp"

namespace talus::service {

enum class Role { none, read, submit };

struct Incoming {
  std::string method, path;
  std::multimap<std::string, std::string> query;
  std::map<std::string, std::string> headers;  ///< names in lower case
  std::string body;
  /// Stop is requested when nobody waits for the answer any more: the client is gone, the time for the request is over,
  /// or talusd stops. Whatever works for this request asks for it and then throws or returns at once.
  std::stop_token stop = {};

  std::string header(const std::string& name) const {
    const auto at = headers.find(name);
    return at == headers.end() ? "" : at->second;
  }
  std::optional<std::string> parameter(const std::string& name) const {
    const auto at = query.find(name);
    return at == query.end() ? std::nullopt : std::optional(at->second);
  }
};

/// Writes one piece of a stream. @return false if the client is gone or the server is stopping
using Sink = std::function<bool(const std::string&)>;

inline constexpr const char* event_stream = "text/event-stream";

struct Answer {
  int status = 200;
  std::string type = "application/json";
  std::string body = {};
  std::vector<std::pair<std::string, std::string>> headers = {};
  std::function<void(const Sink&)> stream = {};  ///< instead of a body
};

/// A larger body goes to a lane of its own, which must not wait for anything.
inline constexpr std::size_t large_body = 256 << 10;

/// Who does the work of a request.
enum class Lane {
  immediate,   ///< the thread of the sockets: a constant answer, of which there can be any number
  operation,   ///< for the operator, whatever else goes on
  request,     ///< reads and changes of the queue
  production,  ///< what is computed for the request
  waiting      ///< waits for something else
};

/// What is to be done with a request whose body has not been read yet.
struct Admission {
  /// Called once, with the body, from another thread; does not throw.
  std::function<Answer(std::string body, std::stop_token stop)> handle = {};
  std::optional<Answer> refusal = {};  ///< instead: the answer, without the body
  Lane lane = Lane::request;
  std::string subject = {};
  std::chrono::seconds limit{120};  ///< until the answer
};

struct Service;

/// A request being handled, its sender, and the captured parts of the path.
struct Exchange {
  Service& service;
  Incoming request;
  std::vector<std::string> captured = {};  ///< path segments that match the {} of the route
  std::string subject = "local";
  Role role = Role::submit;
  std::string base = {};  ///< "http://127.0.0.1:8080": before the path of absolute links

  Caller caller() const { return {.subject = subject, .stop = request.stop}; }
};

inline Answer json_answer(const Json& body, int status = 200) { return {.status = status, .body = dump(body) + "\n"}; }

/// The problem document (RFC 9457) of a refused request: {type, title, status, detail, errors}.
/// @param accept  the client's Accept header: problem+json only for clients that ask for it
Answer problem(const Refusal& refusal, const std::string& accept);

/// The answer to any exception; details are given only where a client can act on them.
Answer problem(std::exception_ptr thrown, const std::string& accept);

}  // namespace talus::service
