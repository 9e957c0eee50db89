#pragma once
// The socket of one client: complete requests in, bytes out, both with a time limit. Used by one thread at a time.

#include <chrono>
#include <functional>
#include <string>

#include "http/guard.hpp"
#include "support/files.hpp"

namespace talus::service {

/// A complete, valid request.
struct WholeRequest {
  Head head;
  std::string body;
};
class Connection {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param request_limit  from the first byte of a request to its last
  /// @param stopping  polled: whether the server is shutting down
  Connection(int fd, const GuardLimits& limits, std::chrono::milliseconds request_limit, std::function<bool()> stopping)
      : fd_(fd), limits_(limits), request_limit_(request_limit), stopping_(std::move(stopping)) {}

  /// @return nothing where the client has closed the connection or sends nothing any more
  /// @throws BadRequest
  std::optional<WholeRequest> next();
  /// Writes all bytes. @return false if the client is gone or too slow, or the server is stopping
  bool write(const char* data, std::size_t size);
  bool write(const std::string& text) { return write(text.data(), text.size()); }
  /// Closes the sending side and keeps reading for a moment, so that the client receives the last response.
  void finish();
  int socket() const { return fd_.get(); }

 private:
  enum class Got { bytes, nothing, end };
  Got receive(Clock::time_point deadline);
  bool wait_for(short events, Clock::time_point deadline) const;

  FileDescriptor fd_;
  const GuardLimits& limits_;
  std::chrono::milliseconds request_limit_;
  std::function<bool()> stopping_;
  std::string buffer_;  ///< received, not yet returned
};

}  // namespace talus::service
