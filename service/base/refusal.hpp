#pragma once
// Why a request is rejected: thrown anywhere, turned into a response in one place (http/problem).

#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "support/faults.hpp"

namespace talus::service {

/// A kind of refusal: the status of HTTP, and type and title of the problem document (RFC 9457).
struct Reason {
  int status;
  const char* type;
  const char* title;
  /// By content: a literal has another address in every translation unit.
  bool operator==(const Reason& other) const {
    return status == other.status && type == std::string_view(other.type) && title == std::string_view(other.title);
  }
};

namespace reason {
inline constexpr Reason bad_request{400, "urn:talus:problem:bad-request", "Bad request"};
inline constexpr Reason unauthorized{401, "urn:talus:problem:unauthorized", "A token is required"};
inline constexpr Reason forbidden{403, "urn:talus:problem:forbidden", "Not allowed"};
inline constexpr Reason not_found{404, "urn:talus:problem:not-found", "Not found"};
inline constexpr Reason no_such_process{
    404, "http://www.opengis.net/def/exceptions/ogcapi-processes-1/1.0/no-such-process", "No such process"};
inline constexpr Reason no_such_job{404, "http://www.opengis.net/def/exceptions/ogcapi-processes-1/1.0/no-such-job",
                                    "No such job"};
inline constexpr Reason result_not_ready{
    404, "http://www.opengis.net/def/exceptions/ogcapi-processes-1/1.0/result-not-ready", "The result is not ready"};
inline constexpr Reason job_dismissed{410, "urn:talus:problem:job-dismissed", "The job was dismissed"};
inline constexpr Reason method_not_allowed{405, "urn:talus:problem:method-not-allowed", "Method not allowed"};
inline constexpr Reason conflict{409, "urn:talus:problem:conflict", "Conflict with the current state"};
inline constexpr Reason length_required{411, "urn:talus:problem:length-required", "Content-Length is required"};
inline constexpr Reason too_large{413, "urn:talus:problem:too-large", "Too large"};
inline constexpr Reason uri_too_long{414, "urn:talus:problem:uri-too-long", "The URI is too long"};
inline constexpr Reason unsupported_media_type{415, "urn:talus:problem:unsupported-media-type",
                                               "Unsupported media type"};
inline constexpr Reason unprocessable{422, "urn:talus:problem:unprocessable", "Unprocessable request"};
inline constexpr Reason quota{422, "urn:talus:problem:quota-exceeded", "Quota exceeded"};
inline constexpr Reason queue_full{429, "urn:talus:problem:queue-full", "The queue is full"};
inline constexpr Reason headers_too_large{431, "urn:talus:problem:headers-too-large", "The headers are too large"};
inline constexpr Reason internal{500, "urn:talus:problem:internal", "Internal error"};
inline constexpr Reason unavailable{503, "urn:talus:problem:unavailable", "Temporarily unavailable"};
inline constexpr Reason timeout{504, "urn:talus:problem:timeout", "Time limit exceeded"};
inline constexpr Reason disk_full{507, "urn:talus:problem:disk-full", "Insufficient storage"};
// Of the guard.
inline constexpr Reason request_timeout{408, "about:blank", "Request timeout"};
inline constexpr Reason expectation_failed{417, "about:blank", "Expectation failed"};
inline constexpr Reason version_not_supported{505, "about:blank", "HTTP version not supported"};
}  // namespace reason

struct Refusal : std::runtime_error {
  Refusal(Reason why, const std::string& detail, std::vector<Fault> all = {}, std::optional<int> retry_after_s = {})
      : std::runtime_error(detail), reason(why), faults(std::move(all)), retry_after(retry_after_s) {}
  Reason reason;
  std::vector<Fault> faults;
  std::optional<int> retry_after;  ///< [s]
  std::string allow = {};          ///< of method_not_allowed: the allowed methods
};

/// @throws Refusal with all faults, if there are any
inline void refuse_if_any(const Faults& faults, Reason reason, const std::string& detail) {
  if (!faults.empty()) throw Refusal(reason, detail, faults.all());
}

}  // namespace talus::service
