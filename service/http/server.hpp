#pragma once
// The HTTP server: one thread for all sockets, others for the handlers.

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
  /// Ends the connections and waits for the handlers, of which each is told by its stop token.
  virtual void stop() = 0;
};

/// @param admit  called in the thread of the sockets for every valid head: must not wait
std::unique_ptr<Server> make_server(const Config& config, std::function<Admission(Incoming)> admit);

}  // namespace talus::service
