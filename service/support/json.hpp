#pragma once
// JSON that comes from outside: looked over before it is parsed.

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "support/refusal.hpp"

namespace talus::service {

using Json = nlohmann::ordered_json;

/// What a document may hold at most. Nested values and long strings are what overflows stacks (of parsers, and of
/// std::regex in validators), so both are counted in the raw text.
struct JsonLimits {
  std::size_t nesting = 64;
  std::size_t string_bytes = 4096;
};

/// Parses a request body.
/// @throws Refusal bad_request: not UTF-8 JSON, a key twice in an object, deeper or longer than the limits
Json parse_json(std::string_view text, const JsonLimits& limits = {});

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

/// The token of a JSON pointer for a key: ~ and / escaped.
std::string pointer_token(const std::string& key);

}  // namespace talus::service
