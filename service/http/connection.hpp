#pragma once
// One client's socket: whole requests in, bytes out, both within their time.

#include <chrono>
#include <functional>
#include <string>
#include <variant>

#include "http/guard.hpp"
#include "support/files.hpp"

namespace talus::service {

/// A request that has come whole and been judged good.
struct WholeRequest {
  Head head;
  std::string body;
};
/// A request that has been judged bad; what comes after it cannot be told apart, so the connection ends.
struct BadRequest {
  int status;
  std::string why;
};
struct Closed {};

struct Timing {
  std::chrono::milliseconds idle{5000};      ///< between two requests
  std::chrono::milliseconds request{15000};  ///< from the first byte of a request to its last
  std::chrono::milliseconds write{20000};    ///< for a client to take what we send
};

class Connection {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param stopping  asked now and then: whether the server is going down
  Connection(int fd, const GuardLimits& limits, const Timing& timing, std::function<bool()> stopping);

  std::variant<WholeRequest, BadRequest, Closed> next();
  /// Writes all of it, or fails: the other side is gone, too slow, or we are stopping.
  bool write(const char* data, std::size_t size);
  bool write(const std::string& text) { return write(text.data(), text.size()); }
  /// Closes the sending side and keeps reading for a moment, so that the client receives the last response.
  void finish();
  int socket() const { return fd_.get(); }

 private:
  enum class Got { bytes, nothing, end };
  Got receive(Clock::time_point deadline);
  bool wait_for(short events, Clock::time_point deadline) const;

  Descriptor fd_;
  const GuardLimits& limits_;
  Timing timing_;
  std::function<bool()> stopping_;
  std::string buffer_;  ///< received, not yet handed out
};

}  // namespace talus::service
