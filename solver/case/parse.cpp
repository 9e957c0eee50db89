#include "case/parse.hpp"

#include <algorithm>
#include <fstream>
#include <set>
#include <vector>

#include "case/faults.hpp"
#include "case/words.hpp"

namespace talus {
namespace {

/// Enforces the limits during parsing and finds duplicate keys: tracks the position, the keys seen and the depth.
class ParseGuard {
 public:
  ParseGuard(const ParseLimits& limits, Faults& faults) : limits_(limits), faults_(faults) {}

  void operator()(Json::parse_event_t event, const Json& parsed) {
    using Event = Json::parse_event_t;
    switch (event) {
      case Event::key:
        enter_key(parsed.get_ref<const std::string&>());
        break;
      case Event::object_start:
        open(false);
        break;
      case Event::array_start:
        open(true);
        break;
      case Event::object_end:
      case Event::array_end:
        levels_.pop_back();
        break;
      case Event::value:
        count();
        if (parsed.is_string()) check_length(parsed.get_ref<const std::string&>().size());
        break;
    }
  }

  /// The place of the value that is being read, or comes next.
  std::string pointer(std::size_t ahead = 0) const {
    std::string path;
    for (const Level& level : levels_) {
      const bool last = &level == &levels_.back();
      path = level.array ? pointer_to(path, level.elements - 1 + (last ? ahead : 0)) : pointer_to(path, level.key);
    }
    return path;
  }

 private:
  struct Level {
    bool array = false;
    std::size_t elements = 0;
    std::string key;
    std::set<std::string> keys;
  };

  void enter_key(const std::string& key) {
    check_length(key.size());
    levels_.back().key = key;
    if (!levels_.back().keys.insert(key).second) faults_.add(pointer(), "appears twice");
    if (levels_.back().keys.size() > limits_.members)
      throw ConfigError(pointer(), "one object holds more than " + std::to_string(limits_.members) + " keys");
  }
  void open(bool array) {
    count();
    levels_.push_back({array, 0, {}, {}});
    if (levels_.size() > limits_.nesting)
      throw ConfigError("", "the document is nested deeper than " + std::to_string(limits_.nesting) + " levels");
  }
  void count() {
    if (!levels_.empty() && levels_.back().array) ++levels_.back().elements;
    if (++values_ > limits_.values)
      throw ConfigError("", "the document holds more than " + std::to_string(limits_.values) + " values");
  }
  void check_length(std::size_t length) {
    if (length > limits_.string)
      throw ConfigError(pointer(), "a string is longer than " + std::to_string(limits_.string) + " bytes");
  }

  const ParseLimits& limits_;
  Faults& faults_;
  std::vector<Level> levels_;
  std::size_t values_ = 0;
};

/// "source:line:column" of a byte counted from 1.
std::string place(std::string_view text, std::size_t byte, const std::string& source) {
  const std::string_view before = text.substr(0, std::min(byte > 0 ? byte - 1 : 0, text.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const auto line_start = before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
  return source + ":" + std::to_string(line) + ":" + std::to_string(before.size() - line_start + 1);
}

/// The message of the JSON library without its preamble.
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

}  // namespace

std::string read_text(const std::filesystem::path& path, std::size_t most) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (error || !std::filesystem::exists(status)) throw IoError(path.string() + ": cannot be read: no such file");
  if (!std::filesystem::is_regular_file(status)) throw IoError(path.string() + ": cannot be read: not a regular file");
  if (std::filesystem::file_size(path, error) > most && !error)
    throw ConfigError(path.filename().string(), "is larger than " + std::to_string(most >> 20) + " MiB");
  std::ifstream in(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!in.is_open() || in.bad()) throw IoError(path.string() + ": cannot be read");
  return text;
}

Json parse_json(std::string_view text, const std::string& source, const ParseLimits& limits) {
  if (text.size() > limits.bytes)
    throw ConfigError(source, "is larger than " + std::to_string(limits.bytes >> 20) + " MiB");
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos)
    throw ConfigError(source + ":1:1", "holds nothing; a case is one JSON object, { ... }");
  Faults faults;
  ParseGuard guard(limits, faults);
  const auto follow = [&](int, Json::parse_event_t event, Json& parsed) {
    guard(event, parsed);
    return true;
  };
  Json document;
  try {
    document = Json::parse(text.begin(), text.end(), follow);
  } catch (const Json::parse_error& e) {
    throw ConfigError(place(text, e.byte, source), parser_message(e.what()) + not_a_number_hint(text, e.byte));
  } catch (const Json::out_of_range&) {
    throw ConfigError(guard.pointer(1), "is too large for a number");
  }
  faults.raise();
  return document;
}

}  // namespace talus
