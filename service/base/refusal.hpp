#pragma once
// Why a request is not carried out: thrown anywhere, turned into an answer in one place (http/problem).

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/error.hpp"

namespace talus::service {

enum class Reason {
  bad_request,
  unauthorized,
  forbidden,
  not_found,
  no_such_process,
  no_such_job,
  result_not_ready,
  job_dismissed,
  method_not_allowed,
  not_acceptable,
  conflict,
  length_required,
  too_large,
  uri_too_long,
  unsupported_media_type,
  unprocessable,
  quota,
  queue_full,
  headers_too_large,
  internal,
  not_implemented,
  unavailable,
  timeout,
  disk_full,
};

struct Refusal : std::runtime_error {
  Refusal(Reason why, const std::string& detail, std::vector<Fault> all = {})
      : std::runtime_error(detail), reason(why), faults(std::move(all)) {}
  Reason reason;
  std::vector<Fault> faults;
  std::string allow;                    ///< of a method_not_allowed: the methods that are
  std::optional<int> retry_after = {};  ///< [s]
};

}  // namespace talus::service
