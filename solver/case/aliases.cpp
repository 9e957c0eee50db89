#include "case/aliases.hpp"

#include <string>

namespace talus {
namespace {

/// "study.seed=5" -> section "study", key "seed", word "5"
struct Parts {
  std::string section, key, word;

  explicit Parts(std::string_view text) {
    const std::size_t dot = text.find('.'), equals = text.find('=');
    section = text.substr(0, dot);
    key = text.substr(dot + 1, equals == std::string_view::npos ? equals : equals - dot - 1);
    if (equals != std::string_view::npos) word = text.substr(equals + 1);
  }
};

bool replace_in(Json& document, const Parts& old, const Parts& present) {
  if (!document.is_object() || !document.contains(old.section)) return false;
  Json& section = document[old.section];
  if (!section.is_object() || !section.contains(old.key)) return false;
  if (old.word.empty() ? section.contains(present.key) : section[old.key] != old.word) return false;
  Json value = old.word.empty() ? section[old.key] : Json(present.word);
  section.erase(old.key);
  section[present.key] = std::move(value);
  return true;
}

/// Of an alias without a word, the part before the equals sign; else the whole text.
bool replace_in(std::string& text, const CaseAlias& renamed, const Parts& old) {
  const std::size_t length = old.word.empty() ? text.find('=') : text.size();
  if (std::string_view(text).substr(0, length) != renamed.alias) return false;
  text.replace(0, renamed.alias.size(), renamed.name);
  return true;
}

}  // namespace

std::vector<Fault> replace_aliases(Json& document, std::vector<std::string>& overrides) {
  std::vector<Fault> warnings;
  for (const CaseAlias& renamed : case_aliases) {
    const Parts old(renamed.alias);
    bool used = replace_in(document, old, Parts(renamed.name));
    for (std::string& text : overrides) used = replace_in(text, renamed, old) || used;
    if (used)
      warnings.push_back({"/" + old.section + "/" + old.key, "is an old spelling; write " + std::string(renamed.name)});
  }
  return warnings;
}

}  // namespace talus
