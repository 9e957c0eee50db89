#pragma once
// Declares and reads the keys of one JSON object. A key is declared by the one call that reads it: the value, its
// default, the fault messages, the JSON Schema, the tables of the documents and the completion follow from that call.

#include <concepts>
#include <functional>
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

/// Another key of a number, in another unit.
struct OtherUnit {
  std::string_view key;
  Quantity q;
  double factor;  ///< times the number under this key is the one under the first
  KeyText text;
};

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
  /// A number that may instead be given in another unit, under a key of its own; recorded under the first. Without
  /// `required` the value on entry is the default.
  void number_in_either(std::string_view key, double& value, const Quantity& q, const KeyText& text, bool required,
                        const OtherUnit& other);
  /// The same without a default: stays unset when absent; then nothing is recorded.
  void optional_number_in_either(std::string_view key, std::optional<double>& value, const Quantity& q,
                                 const KeyText& text, const OtherUnit& other);
  template <std::integral T>
  void integer(std::string_view key, T& value, const Quantity& q, const KeyText& text) {
    if (const auto read = read_number(key, q, text, "integer", value)) value = static_cast<T>(*read);
    record(key, value);
  }
  template <std::integral T>
  void optional_integer(std::string_view key, std::optional<T>& value, const Quantity& q, const KeyText& text) {
    if (const auto read = read_number(key, q, text, "integer")) record(key, value.emplace(static_cast<T>(*read)));
  }
  void flag(std::string_view key, bool& value, const KeyText& text);
  /// Counted in characters, not bytes; it is required if the value on entry is too short.
  void string(std::string_view key, std::string& value, Size length, const KeyText& text);
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

  /// Reads the keys of a member object, or declares them.
  using Read = std::function<void(ObjectReader&)>;
  /// A member object.
  void object(std::string_view key, std::string_view sentence, Absent absent, const Read& read);
  /// false, true (every default) or an object of its own.
  /// @return whether it is on
  bool switchable(std::string_view key, const KeyText& text, const Read& read);
  /// A list of objects; required by the caller.
  /// @param each  the sentence on one of them
  void objects(std::string_view key, Size length, const KeyText& text, std::string_view each, const Read& read);

  /// The value of a key, or null if it is absent; the key counts as known.
  const Json* find(std::string_view key);
  /// Declares a key whose value the caller reads. @param fallback  its default, null when there is none
  void declare(std::string_view key, const Json& schema, const KeyText& text, const std::string& facts,
               const Json& fallback = nullptr, bool required = false);
  /// A fault if both keys are given.
  void exclude(std::string_view key, std::string_view other);
  /// The largest value of a number while a choice is a certain word.
  struct LimitOfWord {
    std::string_view word;
    double most;
  };
  /// A fault if the number `key` is above the limit of the word that `choice` is. The first word is the default.
  /// @param why  the limit is what it is
  void limit_by_choice(std::string_view key, double value, std::string_view choice,
                       std::initializer_list<LimitOfWord> limits, std::string_view why);
  /// Declares that exactly one form is given; the caller checks it and words the faults.
  void one_form(std::initializer_list<Form> forms);
  /// From here on defaults are shown as these words, and no key is required.
  void describe_defaults_as(std::string_view words) { default_words_ = words; }
  /// Whether keys without a default are required here.
  bool requires_keys() const { return default_words_.empty(); }

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
  ObjectReader child_at(std::string_view key, const Json* value, Absent absent);
  std::optional<double> read_number(std::string_view key, const Quantity& q, const KeyText& text,
                                    std::string_view type = "number", const Json& fallback = nullptr,
                                    bool required = false);
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

/// A value as it stands in the file, shortened; of an array or an object with more than 100 values how many it holds.
std::string quote(const Json& value);

}  // namespace talus
