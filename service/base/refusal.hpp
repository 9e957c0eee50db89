#pragma once
// Why a request is rejected: thrown anywhere, turned into a response in one place (http/problem).

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/faults.hpp"

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
