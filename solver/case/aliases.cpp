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

}  // namespace

std::vector<Fault> replace_aliases(Json& document) {
  std::vector<Fault> warnings;
  for (const auto& [alias, name] : case_aliases) {
    const Parts old(alias), present(name);
    if (!document.is_object() || !document.contains(old.section)) continue;
    Json& section = document[old.section];
    if (!section.is_object() || !section.contains(old.key)) continue;
    if (old.word.empty()) {
      if (section.contains(present.key)) continue;
      section[present.key] = section[old.key];
      section.erase(old.key);
    } else {
      if (section[old.key] != old.word) continue;
      section[old.key] = present.word;
    }
    warnings.push_back({"/" + old.section + "/" + old.key, "is an old spelling; write " + std::string(name)});
  }
  return warnings;
}

}  // namespace talus
