#include "http/router.hpp"

namespace talus::service {
namespace {

std::vector<std::string> segments_of(const std::string& path) {
  std::vector<std::string> all;
  for (std::size_t start = 1; start <= path.size();) {
    const std::size_t end = std::min(path.find('/', start), path.size());
    all.push_back(path.substr(start, end - start));
    start = end + 1;
  }
  if (all.size() > 1 && all.back().empty()) all.pop_back();  // "/jobs/" is "/jobs"
  return all;
}

bool matches(const std::vector<std::string>& pattern, const std::vector<std::string>& path,
             std::vector<std::string>& captured) {
  if (pattern.size() != path.size()) return false;
  captured.clear();
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (pattern[i] == "{}")
      captured.push_back(path[i]);
    else if (pattern[i] != path[i])
      return false;
  }
  return true;
}

}  // namespace

void Router::add(const std::string& method, const std::string& pattern, Role role, Handler handler) {
  routes_.push_back({method, segments_of(pattern), role, std::move(handler)});
}

Router::Found Router::find(const std::string& method, const std::string& path) const {
  Found found;
  const std::vector<std::string> segments = segments_of(path);
  const auto allow = [&found](const std::string& known) {
    found.allow += (found.allow.empty() ? "" : ", ") + known + (known == "GET" ? ", HEAD" : "");
  };
  for (const Route& route : routes_) {
    std::vector<std::string> captured;
    if (path == "*") {
      if (found.allow.find(route.method) == std::string::npos) allow(route.method);
      continue;
    }
    if (!matches(route.segments, segments, captured)) continue;
    allow(route.method);
    if (route.method != method && !(route.method == "GET" && method == "HEAD")) continue;
    found.handler = &route.handler;
    found.role = route.role;
    found.captured = std::move(captured);
  }
  if (!found.allow.empty()) found.allow += ", OPTIONS";
  return found;
}

}  // namespace talus::service
