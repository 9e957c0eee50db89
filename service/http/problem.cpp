#include <cerrno>
#include <filesystem>

#include "base/json.hpp"
#include "http/message.hpp"
#include "queue/database.hpp"
#include "support/files.hpp"

namespace talus::service {
namespace {

/// Statuses that the guard or the HTTP library answers and no handler does.
constexpr Reason other_reasons[] = {{408, "about:blank", "Request timeout"},
                                    {417, "about:blank", "Expectation failed"},
                                    {505, "about:blank", "HTTP version not supported"}};

Reason reason_of(int status) {
  for (const Reason* reason : reason::all)
    if (reason->status == status) return *reason;
  for (const Reason& reason : other_reasons)
    if (reason.status == status) return reason;
  return {status, "about:blank", status < 500 ? "Bad request" : "Internal error"};
}

Answer file_problem(int error, const char* what, const std::string& accept) {
  log_error("files", {{"why", what}});
  if (error == ENOSPC || error == EDQUOT) return problem(Refusal(reason::disk_full, "the disk is full"), accept);
  return problem(Refusal(reason::unavailable, "the service cannot read or write one of its files"), accept);
}

}  // namespace

Answer problem(const Refusal& refusal, const std::string& accept) {
  const Reason& reason = refusal.reason;
  Json body = {{"type", reason.type}, {"title", reason.title}, {"status", reason.status}, {"detail", refusal.what()}};
  for (const Fault& fault : refusal.faults)
    body["errors"].push_back({{"pointer", fault.pointer}, {"message", fault.message}});
  Answer answer = json_answer(body, reason.status);
  if (accept.find("application/problem+json") != std::string::npos) answer.type = "application/problem+json";
  if (!refusal.allow.empty()) answer.headers.emplace_back("Allow", refusal.allow);
  if (reason == reason::unauthorized) answer.headers.emplace_back("WWW-Authenticate", "Bearer");
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

Answer problem(int status, const std::string& accept, const std::string& detail) {
  const Reason reason = reason_of(status);
  return problem(Refusal(reason, detail.empty() ? reason.title : detail), accept);
}

const char* status_text(int status) { return reason_of(status).title; }

}  // namespace talus::service
