#pragma once
// cpp-httplib with our guard in front: it parses, routes nothing, writes answers.

#include <functional>
#include <memory>
#include <string>

#include "http/connection.hpp"
#include "http/message.hpp"

namespace talus::service {

struct ServerSettings {
  GuardLimits guard;
  Timing timing;
  int threads = 256;
};

class Server {
 public:
  /// @param handle  called for every good request, by many threads at once; throws nothing
  Server(ServerSettings settings, std::function<Answer(const Incoming&)> handle);
  ~Server();

  /// @param port  0: any free one
  /// @return the port; 0 where the address cannot be had
  int bind(const std::string& address, int port);
  /// Serves until stop() is called.
  void serve();
  void stop();

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace talus::service
