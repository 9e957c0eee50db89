#include "support/json.hpp"

#include <algorithm>
#include <unordered_set>
#include <utility>
#include <vector>

#include "support/digest.hpp"
#include "support/faults.hpp"
#include "support/files.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

/// "source:line:column" of a byte counted from 1.
std::string place(std::string_view text, std::size_t byte, const std::string& source) {
  const std::string_view before = text.substr(0, std::min(byte > 0 ? byte - 1 : 0, text.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const auto line_start = before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
  return source + ":" + std::to_string(line) + ":" + std::to_string(before.size() - line_start + 1);
}

/// The message of the library's parser without its preamble.
std::string parser_message(std::string_view what) {
  if (const auto at = what.find("column "); at != std::string_view::npos)
    if (const auto colon = what.find(": ", at); colon != std::string_view::npos) what.remove_prefix(colon + 2);
  return shorten(what, 200);
}

/// A hint when the parser stumbled over a number that JSON does not have.
std::string not_a_number_hint(std::string_view text, std::size_t byte) {
  const std::size_t from = std::min(byte > 10 ? byte - 10 : 0, text.size());
  const std::string_view around = text.substr(from, 20);
  for (const std::string_view word : {"NaN", "nan", "Infinity", "inf"})
    if (around.find(word) != std::string_view::npos)
      return "; NaN and Infinity are not JSON, every number must be finite";
  return "";
}

/// Builds the document from the parser's events and holds the limits on the way.
class Builder : public nlohmann::json_sax<Json> {
 public:
  Builder(std::string_view text, const std::string& source, const JsonLimits& limits)
      : text_(text), source_(source), limits_(limits) {}

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override { return add(value); }
  bool binary(binary_t&) override { return false; }  // not of JSON
  bool string(string_t& value) override {
    Json& added = insert(std::move(value));
    check_length(added.get_ref<const std::string&>().size());
    return true;
  }
  bool start_object(std::size_t) override { return open(Json::object()); }
  bool start_array(std::size_t) override { return open(Json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t& key) override {
    Level& level = levels_.back();
    level.key = std::move(key);
    check_length(level.key.size());
    if (!level.keys.insert(level.key).second) faults_.add(pointer(), "appears twice");
    if (level.keys.size() > limits_.members)
      throw ConfigError(pointer(), "one object holds more than " + std::to_string(limits_.members) + " keys");
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception& e) override {
    const auto* syntax = dynamic_cast<const Json::parse_error*>(&e);
    if (syntax == nullptr) throw ConfigError(pointer(1), "is too large for a number");
    if (const auto start = text_.find_first_not_of(" \t\r\n"); text_[start] != '{' && text_[start] != '[')
      throw ConfigError(source_, "is not JSON: it begins with " +
                                     in_quotes(text_.substr(start, text_.find_first_of("\r\n", start) - start)) +
                                     "; an object { ... } is expected" +
                                     (source_.ends_with(".csv") ? ", with this CSV file as the value of a key" : "") +
                                     not_a_number_hint(text_, syntax->byte));
    throw ConfigError(place(text_, syntax->byte, source_),
                      parser_message(e.what()) + not_a_number_hint(text_, syntax->byte));
  }

  /// @throws ConfigError when a key appeared twice
  Json finish() {
    faults_.raise();
    return std::move(document_);
  }

 private:
  struct Level {
    Json* value;           ///< object or array that is open
    std::string key = {};  ///< of an object: the last one
    std::unordered_set<std::string> keys = {};
  };

  /// The place of the last value read; `ahead` = 1: of the value that comes next.
  std::string pointer(std::size_t ahead = 0) const {
    std::string path;
    for (const Level& level : levels_) {
      const bool last = &level == &levels_.back();
      path = level.value->is_array() ? pointer_to(path, level.value->size() + (last ? ahead : 0) - 1)
                                     : pointer_to(path, level.key);
    }
    return path;
  }

  bool add(Json value) {
    insert(std::move(value));
    return true;
  }
  bool open(Json empty) {
    Json& value = insert(std::move(empty));
    if (levels_.size() == limits_.nesting)
      throw ConfigError("", "the document is nested deeper than " + std::to_string(limits_.nesting) + " levels");
    levels_.push_back({.value = &value});
    return true;
  }
  bool close() {
    levels_.pop_back();
    return true;
  }
  /// Appends a value to the open container. The keys have been compared already, so no search is needed.
  Json& insert(Json value) {
    if (++values_ > limits_.values)
      throw ConfigError("", "the document holds more than " + std::to_string(limits_.values) + " values");
    if (levels_.empty()) return document_ = std::move(value);
    Json& parent = *levels_.back().value;
    if (parent.is_array()) return parent.get_ref<Json::array_t&>().emplace_back(std::move(value));
    Json::object_t::Container& members = parent.get_ref<Json::object_t&>();
    return members.emplace_back(levels_.back().key, std::move(value)).second;
  }
  void check_length(std::size_t length) const {
    if (length > limits_.string)
      throw ConfigError(pointer(), "a string is longer than " + std::to_string(limits_.string) + " bytes");
  }

  std::string_view text_;
  const std::string& source_;
  const JsonLimits& limits_;
  Json document_;
  std::vector<Level> levels_;
  Faults faults_;
  std::size_t values_ = 0;
};

constexpr std::string_view checksum_begin = ",\n  \"checksum\": \"", checksum_end = "\"\n}\n";
constexpr std::size_t checksum_digits = 16;

/// Whether the text of a file agrees with the checksum at its end; true where there is none.
bool is_whole(std::string_view text) {
  const std::size_t tail = checksum_begin.size() + checksum_digits + checksum_end.size();
  if (text.size() < tail) return true;
  const std::string_view before = text.substr(0, text.size() - tail), end = text.substr(before.size());
  if (!end.starts_with(checksum_begin) || !end.ends_with(checksum_end)) return true;
  return end.substr(checksum_begin.size(), checksum_digits) == hex_digits(fnv1a64(before));
}

}  // namespace

std::string with_checksum(const Json& object) {
  std::string text = object.dump(2, ' ', false, Json::error_handler_t::replace);
  text.resize(text.size() - std::string_view("\n}").size());
  const std::string checksum = hex_digits(fnv1a64(text));
  return text.append(checksum_begin).append(checksum).append(checksum_end);
}

std::string read_text(const std::filesystem::path& path, std::size_t most) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw IoError(path.string() + ": cannot be read: no such file");
  if (!std::filesystem::is_regular_file(status)) throw IoError(path.string() + ": cannot be read: not a regular file");
  if (std::filesystem::file_size(path, error) > most && !error)
    throw ConfigError(path.filename().string(), "is larger than " + std::to_string(most >> 20) + " MiB");
  return read_file(path, most);
}

Json parse_json(std::string_view text, const std::string& source, const JsonLimits& limits) {
  if (text.size() > limits.bytes)
    throw ConfigError(source, "is larger than " + std::to_string(limits.bytes >> 20) + " MiB");
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos)
    throw ConfigError(source + ":1:1", "is empty; one JSON value is expected, such as an object { ... }");
  Builder builder(text, source, limits);
  Json::sax_parse(text.begin(), text.end(), &builder);
  return builder.finish();
}

Json read_json(const std::filesystem::path& path, std::size_t max_bytes) {
  const std::string text = read_file(path, max_bytes);
  if (!is_whole(text)) throw IoError(path.string() + " is damaged: its text does not agree with its checksum");
  try {
    return parse_json(text, path.filename().string(), own_file(max_bytes));
  } catch (const ConfigError& e) {
    throw IoError(path.string() + " is not JSON that can be read: " + e.what());
  }
}

}  // namespace talus
