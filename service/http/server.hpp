#pragma once
// cpp-httplib behind the guard: it parses requests and writes answers, but routes nothing.

#include <functional>
#include <memory>
#include <string>

#include "http/message.hpp"
#include "jobs/config.hpp"

namespace talus::service {

class Server {
 public:
  virtual ~Server() = default;
  /// @param port  0: any free one
  /// @return the port; 0 if the address cannot be bound
  virtual int bind(const std::string& address, int port) = 0;
  /// Serves until stop() is called.
  virtual void serve() = 0;
  virtual void stop() = 0;
};

/// @param loopback_names_only  see GuardLimits
/// @param handle  called for every valid request, concurrently from many threads; must not throw
std::unique_ptr<Server> make_server(const Config& config, bool loopback_names_only,
                                    std::function<Answer(Incoming)> handle);

}  // namespace talus::service
