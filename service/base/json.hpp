#pragma once
// JSON that comes in a request: parsed within the limits that hold for every document, faults as a refusal.

#include <string>
#include <string_view>
#include <vector>

#include "base/refusal.hpp"
#include "support/json.hpp"

namespace talus::service {

/// Parses a request body.
/// @throws Refusal bad_request: not UTF-8 JSON, a key twice in an object, or beyond JsonLimits
Json parse_body(std::string_view text);

/// One line, with what is not UTF-8 replaced.
std::string dump(const Json& value);

/// Collects what is wrong with a document and throws it all at once.
class Checker {
 public:
  void fault(std::string pointer, std::string message) { faults_.push_back({std::move(pointer), std::move(message)}); }
  bool ok() const { return faults_.empty(); }
  /// @throws Refusal with everything collected, if anything
  void finish(Reason reason, const std::string& detail) {
    if (!ok()) throw Refusal(reason, detail, std::move(faults_));
  }

 private:
  std::vector<Fault> faults_;
};

}  // namespace talus::service
