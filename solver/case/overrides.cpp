#include "case/overrides.hpp"

#include <charconv>

#include "support/text.hpp"

namespace talus {
namespace {

std::vector<std::string> split_path(std::string_view path) {
  std::vector<std::string> parts(1);
  for (const char c : path)
    if (c == '.')
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

/// "study.seed=5" -> "/study/seed" and "5"
struct PathAndWord {
  Json::json_pointer path;
  std::string word;

  explicit PathAndWord(std::string_view text) {
    const std::size_t end = std::min(text.find('='), text.size());
    for (const std::string& part : split_path(text.substr(0, end))) path /= part;
    word = text.substr(std::min(end + 1, text.size()));
  }
};

/// @return whether the alias stands in the document, alone
bool replace_in(Json& document, const PathAndWord& alias, const PathAndWord& name) {
  if (!document.contains(alias.path)) return false;
  const Json value = document[alias.path];
  if (alias.word.empty() ? document.contains(name.path) : value != alias.word) return false;
  document[alias.path.parent_pointer()].erase(alias.path.back());
  document[name.path] = alias.word.empty() ? value : Json(name.word);
  return true;
}

/// Of an alias without a word, the part before the equals sign; else the whole text.
bool replace_in(std::string& text, const CaseAlias& renamed) {
  const bool with_word = renamed.alias.find('=') != std::string_view::npos;
  if (std::string_view(text).substr(0, with_word ? text.size() : text.find('=')) != renamed.alias) return false;
  text.replace(0, renamed.alias.size(), renamed.name);
  return true;
}

/// JSON, or else a plain string. Limits and doubled keys of JSON are refused all the same.
Json parse_value(std::string_view text, const std::string& source) {
  return Json::accept(text.begin(), text.end()) ? parse_json(text, source) : Json(std::string(text));
}

/// The member or element `part` of `node`; a missing member is made. Null (with a fault) where there is nothing to
/// enter.
Json* enter(Json& node, const std::string& part, const std::string& pointer, Faults& faults) {
  if (node.is_object()) return &node[part];
  if (!node.is_array()) {
    faults.add(pointer, "is neither object nor array, it holds nothing called " + in_quotes(part));
    return nullptr;
  }
  std::size_t index = node.size();
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
  if (error == std::errc{} && end == part.data() + part.size() && index < node.size()) return &node[index];
  faults.add(pointer,
             "has no element " + in_quotes(part) + ", it has " + std::to_string(node.size()) + " (counted from 0)");
  return nullptr;
}

/// Sets the value at a path. @return the pointer of the value, or of the last part of the path that exists
std::string set(Json& document, const std::vector<std::string>& parts, Json value, Faults& faults) {
  Json* node = &document;
  std::string pointer;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (k + 1 == parts.size() && value.is_null() && node->is_object()) {
      node->erase(parts[k]);
      return pointer_to(pointer, parts[k]);
    }
    if (node->is_null()) *node = Json::object();
    node = enter(*node, parts[k], pointer, faults);
    if (node == nullptr) return pointer;
    pointer = pointer_to(pointer, parts[k]);
  }
  *node = std::move(value);
  return pointer;
}

}  // namespace

std::vector<Fault> replace_aliases(Json& document, std::vector<std::string>& overrides) {
  std::vector<Fault> warnings;
  for (const CaseAlias& renamed : case_aliases) {
    const PathAndWord alias(renamed.alias);
    bool used = replace_in(document, alias, PathAndWord(renamed.name));
    for (std::string& text : overrides) used = replace_in(text, renamed) || used;
    if (used) warnings.push_back({alias.path.to_string(), "is an old spelling; write " + std::string(renamed.name)});
  }
  return warnings;
}

std::vector<Override> apply_overrides(Json& document, std::span<const std::string> overrides, Faults& faults) {
  std::vector<Override> applied;
  for (const std::string& text : overrides) {
    const auto equals = text.find('=');
    const std::vector<std::string> parts = split_path(std::string_view(text).substr(0, equals));
    bool whole = equals != std::string::npos;
    for (const std::string& part : parts) whole = whole && !part.empty();
    if (!whole) {
      faults.add("--set " + shorten(text), "is not of the form key.path=value");
      continue;
    }
    Json value = parse_value(std::string_view(text).substr(equals + 1), "--set " + shorten(text));
    applied.push_back({set(document, parts, std::move(value), faults), shorten(text)});
  }
  return applied;
}

std::vector<Fault> name_origins(std::vector<Fault> faults, std::span<const Override> overrides) {
  for (Fault& fault : faults)
    for (const Override& o : overrides)
      if (!fault.pointer.empty() && (lies_under(fault.pointer, o.pointer) || lies_under(o.pointer, fault.pointer))) {
        fault.message += " (from --set " + o.text + ")";
        break;
      }
  return faults;
}

}  // namespace talus
