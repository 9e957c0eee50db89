#pragma once
// Maps method and path of a request to a handler.

#include <functional>
#include <string>
#include <vector>

#include "http/message.hpp"

namespace talus::service {

using Handler = std::function<Answer(Exchange&)>;

class Router {
 public:
  /// @param pattern  "/jobs/{}/results": {} stands for one segment
  /// @param role     minimum role of the token
  void add(const std::string& method, const std::string& pattern, Role role, Handler handler);

  struct Found {
    const Handler* handler = nullptr;  ///< none: no such path, or, with `allow`, not this method
    Role role = Role::none;
    std::vector<std::string> captured;
    std::string allow;  ///< methods allowed on the path
  };
  /// HEAD is answered by GET's handler. Path "*" is the server: it allows what any path does, and has no handler.
  Found find(const std::string& method, const std::string& path) const;

 private:
  struct Route {
    std::string method;
    std::vector<std::string> segments;
    Role role;
    Handler handler;
  };
  std::vector<Route> routes_;
};

}  // namespace talus::service
