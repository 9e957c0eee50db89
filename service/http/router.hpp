#pragma once
// The routes: method and path of a request to a handler.

#include <string>
#include <vector>

#include "http/message.hpp"

namespace talus::service {

using Handler = Answer (*)(Exchange&);

struct Route {
  const char* method;
  const char* pattern;  ///< "/jobs/{}/results": {} stands for one segment
  Role role;            ///< minimum role of the token
  Handler handler;
};

using Routes = std::vector<Route>;

/// What a request asks for.
struct FoundRoute {
  const Route* route = nullptr;  ///< null: no such path or, with `allow`, not this method
  std::vector<std::string> captured = {};
  std::string allow = {};  ///< methods allowed on the path; empty: no such path
};
/// HEAD is answered by the handler of GET. Path "*" is the server: it allows what any path does, and has no handler.
FoundRoute find_route(const Routes& routes, const std::string& method, const std::string& path);

}  // namespace talus::service
