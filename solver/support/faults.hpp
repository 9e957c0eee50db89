#pragma once
// Faults of a case file, collected so that a person sees all of them at once.

#include <string>
#include <string_view>
#include <vector>

#include "support/error.hpp"

namespace talus {

/// A growing list of faults; keeps the first 100 and counts the rest.
class Faults {
 public:
  void add(std::string pointer, std::string message);
  bool empty() const { return list_.empty(); }
  std::size_t size() const { return list_.size() + dropped_; }
  /// Whether no fault lies at `pointer` or below it.
  bool none_under(std::string_view pointer) const;
  /// The faults kept, and one line that says how many more there were.
  std::vector<Fault> all() const;
  /// @throws ConfigError with all() unless the list is empty
  void raise() const;

 private:
  std::vector<Fault> list_;
  std::size_t dropped_ = 0;
};

/// `pointer` with one more reference token, escaped as RFC 6901 wants it (~0, ~1).
std::string pointer_to(const std::string& pointer, std::string_view key);
std::string pointer_to(const std::string& pointer, std::size_t index);
/// Whether `pointer` is `ancestor` or lies below it.
bool lies_under(std::string_view pointer, std::string_view ancestor);

}  // namespace talus
