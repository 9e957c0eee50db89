#pragma once
// Reads one JSON object key by key: each read checks, and either notes a fault or records the value in force.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "case/faults.hpp"
#include "case/parse.hpp"

namespace talus {

/// What numbers a key takes: unit and range.
struct Quantity {
  std::string_view unit;  ///< as in "m/s2"; "" for a pure number
  double lo = 0.0;
  double hi = 0.0;
  bool lo_open = false;  ///< lo itself is not allowed
  bool hi_open = false;  ///< hi itself is not allowed

  bool allows(double x) const { return (lo_open ? x > lo : x >= lo) && (hi_open ? x < hi : x <= hi); }
  /// "unit Pa, allowed >= 0 and <= 1e+09"
  std::string describe() const;
};

/// A name of the file and what it stands for.
template <class E>
using Names = std::pair<std::string_view, E>;

/// A JSON object under examination. Every key asked for becomes a known one; finish() reports those never asked for.
class ObjectReader {
 public:
  /// @param value  anything; if it is no object that is a fault, and all reads then return defaults in silence
  ObjectReader(const Json& value, std::string pointer, Faults& faults);

  /// The value of a key, or null if it is absent; the key counts as known.
  const Json* find(std::string_view key);
  /// A number; required unless `standard` is given.
  double number(std::string_view key, const Quantity& q, std::optional<double> standard = {});
  /// A number that may be absent; then nothing is recorded.
  std::optional<double> maybe_number(std::string_view key, const Quantity& q);
  std::int64_t integer(std::string_view key, const Quantity& q, std::int64_t standard);
  std::optional<std::int64_t> maybe_integer(std::string_view key, const Quantity& q);
  bool flag(std::string_view key, bool standard);
  /// A string of `least` to `most` characters; required unless `standard` is given.
  std::string text(std::string_view key, std::size_t least, std::size_t most, std::optional<std::string> standard = {});
  /// A list of at most `most` numbers; empty when absent.
  std::vector<double> numbers(std::string_view key, const Quantity& q, std::size_t most);
  /// One of several names.
  template <class E, std::size_t N>
  E choice(std::string_view key, const Names<E> (&names)[N], E standard) {
    std::vector<std::string> known;
    std::size_t index = 0;
    for (std::size_t k = 0; k < N; ++k) {
      known.emplace_back(names[k].first);
      if (names[k].second == standard) index = k;
    }
    return names[pick(key, known, index)].second;
  }
  /// A member object; a missing one reads as empty, which is a fault if it is required.
  ObjectReader object(std::string_view key, bool required = false);

  /// Notes a fault at this object (empty key) or at one of its keys.
  void fault(std::string_view key, std::string message);
  /// Puts a value into what finish() returns.
  void record(std::string_view key, Json value);
  std::string pointer(std::string_view key) const { return pointer_to(pointer_, key); }
  /// Reports unknown keys and returns the object with every value in force spelt out.
  Json finish();

  Faults& faults() { return faults_; }

 private:
  struct Mute {};
  ObjectReader(Mute, std::string pointer, Faults& faults)
      : value_(nullptr), pointer_(std::move(pointer)), faults_(faults) {}
  std::optional<double> read(std::string_view key, const Quantity& q);
  std::optional<double> read_whole(std::string_view key, const Quantity& q);
  std::size_t pick(std::string_view key, std::span<const std::string> known, std::size_t standard);

  const Json* value_;  ///< null: mute
  std::string pointer_;
  Faults& faults_;
  std::vector<std::string> known_;
  Json resolved_ = Json::object();
};

/// A finite number within range, or nothing and a fault at `pointer`.
std::optional<double> read_number(const Json& value, const Quantity& q, const std::string& pointer, Faults& faults);

/// A value as it stands in the file, shortened.
std::string quote(const Json& value);

}  // namespace talus
