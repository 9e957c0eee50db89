#include "support/faults.hpp"

#include "support/text.hpp"

namespace talus {
namespace {

constexpr std::size_t most_faults = 100;

}  // namespace

void Faults::add(std::string pointer, std::string message) {
  if (list_.size() < most_faults)
    list_.push_back({std::move(pointer), std::move(message)});
  else
    ++dropped_;
}

bool Faults::none_under(std::string_view pointer) const {
  for (const Fault& f : list_)
    if (lies_under(f.pointer, pointer)) return false;
  return true;
}

std::vector<Fault> Faults::all() const {
  std::vector<Fault> faults = list_;
  if (dropped_ > 0) faults.push_back({"", "and " + std::to_string(dropped_) + " more faults"});
  return faults;
}

void Faults::raise() const {
  if (!empty()) throw ConfigError(all());
}

std::string pointer_to(const std::string& pointer, std::string_view key) {
  std::string token = "/";
  for (const char c : shorten(key, 100)) token += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return pointer + token;
}

std::string pointer_to(const std::string& pointer, std::size_t index) { return pointer + "/" + std::to_string(index); }

bool lies_under(std::string_view pointer, std::string_view ancestor) {
  return pointer.starts_with(ancestor) && (pointer.size() == ancestor.size() || pointer[ancestor.size()] == '/');
}

}  // namespace talus
