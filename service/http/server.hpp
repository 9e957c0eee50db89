#pragma once
// cpp-httplib behind the guard: it parses requests and writes answers, but routes nothing.

#include <functional>
#include <memory>
#include <string>

#include "http/connection.hpp"
#include "http/message.hpp"
#include "jobs/config.hpp"

namespace talus::service {

class Server {
 public:
  /// @param loopback_names_only  see GuardLimits
  /// @param handle  called for every valid request, concurrently from many threads; must not throw
  Server(const Config& config, bool loopback_names_only, std::function<Answer(Incoming)> handle);
  ~Server();

  /// @param port  0: any free one
  /// @return the port; 0 if the address cannot be bound
  int bind(const std::string& address, int port);
  /// Serves until stop() is called.
  void serve();
  void stop();

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace talus::service
