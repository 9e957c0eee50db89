#pragma once
// Declares and reads the keys of one JSON object. A key is declared by the one call that reads it: the value, its
// default, the fault messages, the JSON Schema, the tables of the documents and the completion follow from that call.

#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "support/faults.hpp"
#include "support/json.hpp"

namespace talus {

/// The unit and the range of a number.
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

/// The smallest and the largest number of characters, elements or vertices.
struct Size {
  std::size_t least = 0;
  std::size_t most = 0;
};

/// What the documents say about a key.
struct KeyText {
  std::string_view sentence;            ///< what the key means
  std::string_view source = "user";     ///< where its value comes from
  std::string_view default_words = {};  ///< the default in words, where it is derived or none; else the value is shown
  std::string_view range_words = {};    ///< the range in words, where it depends on other keys
};

/// What happens when a member object is absent.
enum class Absent { defaults, fault, skip };  ///< its keys take their defaults | it is required | it stays unset

/// A word of the file and what it stands for.
template <class E>
using Names = std::pair<std::string_view, E>;

/// Keys that are given together: `required` ones and those that may stand beside them.
struct Form {
  std::vector<std::string_view> required;
  std::vector<std::string_view> allowed = {};
};

/// A JSON object under examination. The variable handed to a read holds the default before and the value after it.
/// finish() reports the keys that no call declared. Not thread-safe.
class ObjectReader {
 public:
  /// @param value  if it is not an object, that is a fault, and every key takes its default in silence
  ObjectReader(const Json& value, std::string pointer, Faults& faults);
  /// A reader of nothing, which collects the declarations as a JSON Schema.
  static ObjectReader describing(Faults& ignored);

  /// @name One key of a type each. A key without a default is required.
  /// @{
  void number(std::string_view key, double& value, const Quantity& q, const KeyText& text);
  void required_number(std::string_view key, double& value, const Quantity& q, const KeyText& text);
  /// Stays unset when absent; then nothing is recorded.
  void optional_number(std::string_view key, std::optional<double>& value, const Quantity& q, const KeyText& text);
  template <std::integral T>
  void integer(std::string_view key, T& value, const Quantity& q, const KeyText& text) {
    value = static_cast<T>(read_integer(key, static_cast<std::int64_t>(value), q, text).value());
  }
  template <std::integral T>
  void optional_integer(std::string_view key, std::optional<T>& value, const Quantity& q, const KeyText& text) {
    if (const auto read = read_integer(key, {}, q, text)) value = static_cast<T>(*read);
  }
  void flag(std::string_view key, bool& value, const KeyText& text);
  /// Counted in characters, not bytes.
  void string(std::string_view key, std::string& value, Size length, const KeyText& text);
  void required_string(std::string_view key, std::string& value, Size length, const KeyText& text);
  /// A list of numbers; it is required if it cannot be empty.
  void numbers(std::string_view key, std::vector<double>& values, const Quantity& q, Size length, const KeyText& text);
  /// One of several words.
  template <class E, std::size_t N>
  void choice(std::string_view key, E& value, const Names<E> (&names)[N], const KeyText& text) {
    std::vector<std::string> words;
    std::size_t index = 0;
    for (std::size_t k = 0; k < N; ++k) {
      words.emplace_back(names[k].first);
      if (names[k].second == value) index = k;
    }
    value = names[pick(key, words, index, text)].second;
  }
  /// @}

  /// A member object, which read(ObjectReader&) reads.
  template <class Read>
  void object(std::string_view key, std::string_view sentence, Absent absent, Read&& read) {
    if (absent == Absent::skip && find(key) == nullptr && !describing_) return;
    ObjectReader child = enter(key, absent);
    read(child);
    leave(key, sentence, absent, child);
  }
  /// false, true (every default) or an object of its own.
  /// @return whether it is on
  template <class Read>
  bool switchable(std::string_view key, const KeyText& text, Read&& read) {
    const Json* value = find(key);
    const bool on = value != nullptr && *value != false;
    if (!on) record(key, false);
    if (!on && !describing_) return false;
    ObjectReader child =
        on && *value == true ? ObjectReader(empty_object(), pointer(key), faults_) : enter(key, Absent::skip);
    read(child);
    leave_switchable(key, text, on, child);
    return on;
  }
  /// A list of objects, each of which read(ObjectReader&) reads; required by the caller.
  template <class Read>
  void objects(std::string_view key, Size length, const KeyText& text, std::string_view each, Read&& read) {
    Json resolved = Json::array();
    if (const Json* list = list_of_objects(key, length))
      for (std::size_t k = 0; k < list->size(); ++k) {
        ObjectReader child((*list)[k], pointer_to(pointer(key), k), faults_);
        read(child);
        resolved.push_back(child.finish());
      }
    record(key, std::move(resolved));
    if (!describing_) return;
    ObjectReader child = describing(faults_);
    read(child);
    describe_objects(key, length, text, each, child);
  }

  /// The value of a key, or null if it is absent; the key counts as known.
  const Json* find(std::string_view key);
  /// Declares a key whose value the caller reads.
  void declare(std::string_view key, Json schema, const KeyText& text, const std::string& facts);
  /// A fault if both keys are given.
  void exclude(std::string_view key, std::string_view other);
  /// Declares that exactly one form is given; the caller checks it and words the faults.
  void one_form(std::initializer_list<Form> forms);
  /// From here on defaults are shown as these words, and no key is required.
  void describe_defaults_as(std::string_view words) { default_words_ = words; }

  /// Notes a fault at this object (empty key) or at one of its keys.
  void fault(std::string_view key, std::string message);
  /// Puts a value into what finish() returns.
  void record(std::string_view key, Json value) { resolved_[std::string(key)] = std::move(value); }
  void remove_record(std::string_view key) { resolved_.erase(std::string(key)); }
  std::string pointer(std::string_view key) const { return pointer_to(pointer_, key); }
  /// Reports unknown keys and returns the object with every value in force spelt out.
  Json finish();
  /// The JSON Schema of what has been declared; empty unless this reader is describing().
  Json take_schema() { return std::move(schema_); }

  Faults& faults() { return faults_; }

 private:
  ObjectReader(std::string pointer, Faults& faults, bool describing)
      : value_(nullptr), pointer_(std::move(pointer)), faults_(faults), describing_(describing) {}
  static const Json& empty_object();
  ObjectReader enter(std::string_view key, Absent absent);
  void leave(std::string_view key, std::string_view sentence, Absent absent, ObjectReader& child);
  void leave_switchable(std::string_view key, const KeyText& text, bool on, ObjectReader& child);
  const Json* list_of_objects(std::string_view key, Size length);
  void describe_objects(std::string_view key, Size length, const KeyText& text, std::string_view each,
                        ObjectReader& child);
  /// Declares a key; `fallback` is its default, null when there is none.
  void declare(std::string_view key, Json schema, const KeyText& text, const std::string& facts, const Json& fallback,
               bool required);
  std::optional<double> read_number(std::string_view key, const Quantity& q);
  std::optional<double> read_whole(std::string_view key, const Quantity& q);
  std::optional<std::int64_t> read_integer(std::string_view key, std::optional<std::int64_t> fallback,
                                           const Quantity& q, const KeyText& text);
  void read_string(std::string_view key, std::string& value, Size length, const KeyText& text, bool required);
  std::size_t pick(std::string_view key, std::span<const std::string> words, std::size_t fallback, const KeyText& text);

  const Json* value_;  ///< null: every read returns its default
  std::string pointer_;
  Faults& faults_;
  bool describing_ = false;
  Json schema_ = Json::object();
  std::string_view default_words_;
  std::vector<std::string> known_;
  Json resolved_ = Json::object();
};

/// A finite number within range, or nothing and a fault at `pointer`.
std::optional<double> read_number(const Json& value, const Quantity& q, const std::string& pointer, Faults& faults);

/// The JSON Schema of a number: type and range.
Json number_schema(const Quantity& q, std::string_view type = "number");

/// A value as it stands in the file, shortened.
std::string quote(const Json& value);

}  // namespace talus
