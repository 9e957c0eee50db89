#include "http/problem.hpp"

#include <algorithm>
#include <cerrno>
#include <filesystem>

#include "base/json.hpp"
#include "queue/database.hpp"
#include "support/files.hpp"

namespace talus::service {
namespace {

/// The response to a refusal.
struct Row {
  Reason reason;
  int status;
  const char* type;
  const char* title;
};

#define OGC_EXCEPTION "http://www.opengis.net/def/exceptions/ogcapi-processes-1/1.0/"

constexpr Row table[] = {
    {Reason::bad_request, 400, "urn:talus:problem:bad-request", "Bad request"},
    {Reason::unauthorized, 401, "urn:talus:problem:unauthorized", "A token is required"},
    {Reason::forbidden, 403, "urn:talus:problem:forbidden", "Not allowed"},
    {Reason::not_found, 404, "urn:talus:problem:not-found", "Not found"},
    {Reason::no_such_process, 404, OGC_EXCEPTION "no-such-process", "No such process"},
    {Reason::no_such_job, 404, OGC_EXCEPTION "no-such-job", "No such job"},
    {Reason::result_not_ready, 404, OGC_EXCEPTION "result-not-ready", "The result is not ready"},
    {Reason::job_dismissed, 410, "urn:talus:problem:job-dismissed", "The job was dismissed"},
    {Reason::method_not_allowed, 405, "urn:talus:problem:method-not-allowed", "Method not allowed"},
    {Reason::not_acceptable, 406, "urn:talus:problem:not-acceptable", "No acceptable representation"},
    {Reason::conflict, 409, "urn:talus:problem:conflict", "Conflict with the current state"},
    {Reason::length_required, 411, "urn:talus:problem:length-required", "Content-Length is required"},
    {Reason::too_large, 413, "urn:talus:problem:too-large", "Too large"},
    {Reason::uri_too_long, 414, "urn:talus:problem:uri-too-long", "The URI is too long"},
    {Reason::unsupported_media_type, 415, "urn:talus:problem:unsupported-media-type", "Unsupported media type"},
    {Reason::unprocessable, 422, "urn:talus:problem:unprocessable", "Unprocessable request"},
    {Reason::quota, 422, "urn:talus:problem:quota-exceeded", "Quota exceeded"},
    {Reason::queue_full, 429, "urn:talus:problem:queue-full", "The queue is full"},
    {Reason::headers_too_large, 431, "urn:talus:problem:headers-too-large", "The headers are too large"},
    {Reason::internal, 500, "urn:talus:problem:internal", "Internal error"},
    {Reason::not_implemented, 501, "urn:talus:problem:not-implemented", "Not implemented"},
    {Reason::unavailable, 503, "urn:talus:problem:unavailable", "Temporarily unavailable"},
    {Reason::timeout, 504, "urn:talus:problem:timeout", "Time limit exceeded"},
    {Reason::disk_full, 507, "urn:talus:problem:disk-full", "Insufficient storage"},
};

/// Statuses that the guard or the HTTP library answers and no handler does.
constexpr std::pair<int, const char*> other_statuses[] = {
    {408, "Request timeout"}, {417, "Expectation failed"}, {505, "HTTP version not supported"}};

/// The first row for which `holds`; null where there is none.
template <class Holds>
const Row* find_row(Holds holds) {
  const auto at = std::find_if(std::begin(table), std::end(table), holds);
  return at == std::end(table) ? nullptr : at;
}
const Row* row_of(int status) {
  return find_row([&](const Row& row) { return row.status == status; });
}

Answer document(const char* type, const char* title, int status, const Refusal& refusal, const std::string& accept) {
  Json body = {{"type", type}, {"title", title}, {"status", status}, {"detail", refusal.what()}};
  for (const Fault& fault : refusal.faults)
    body["errors"].push_back({{"pointer", fault.pointer}, {"message", fault.message}});
  Answer answer = json_answer(body, status);
  if (accept.find("application/problem+json") != std::string::npos) answer.type = "application/problem+json";
  if (!refusal.allow.empty()) answer.headers.emplace_back("Allow", refusal.allow);
  if (status == 401) answer.headers.emplace_back("WWW-Authenticate", "Bearer");
  if (refusal.retry_after) answer.headers.emplace_back("Retry-After", std::to_string(*refusal.retry_after));
  return answer;
}

Answer file_problem(int error, const char* what, const std::string& accept) {
  log_error("files", {{"why", what}});
  if (error == ENOSPC || error == EDQUOT) return problem(Refusal(Reason::disk_full, "the disk is full"), accept);
  return problem(Refusal(Reason::unavailable, "the service cannot read or write one of its files"), accept);
}

}  // namespace

Answer problem(const Refusal& refusal, const std::string& accept) {
  const Row& row = *find_row([&](const Row& r) { return r.reason == refusal.reason; });
  return document(row.type, row.title, row.status, refusal, accept);
}

Answer problem(std::exception_ptr thrown, const std::string& accept) {
  try {
    std::rethrow_exception(thrown);
  } catch (const Refusal& e) {
    return problem(e, accept);
  } catch (const StorageError& e) {
    log_error("storage", {{"why", e.what()}});
    return problem(Refusal(e.disk_full ? Reason::disk_full : Reason::unavailable, e.what(), {}, 30), accept);
  } catch (const IoError& e) {
    return file_problem(e.error, e.what(), accept);
  } catch (const std::filesystem::filesystem_error& e) {
    return file_problem(e.code().value(), e.what(), accept);
  } catch (const std::exception& e) {
    log_error("internal", {{"why", e.what()}});
    return problem(Refusal(Reason::internal, "internal error; details are in the log of talusd"), accept);
  }
}

Answer problem(int status, const std::string& accept, const std::string& detail) {
  const Row* row = row_of(status);
  const char* title = status_text(status);
  return document(row ? row->type : "about:blank", title, status,
                  Refusal(Reason::bad_request, detail.empty() ? title : detail), accept);
}

const char* status_text(int status) {
  if (const Row* row = row_of(status)) return row->title;
  for (const auto& [known, text] : other_statuses)
    if (known == status) return text;
  return status < 500 ? "Bad request" : "Internal error";
}

}  // namespace talus::service
