#include "http/connection.hpp"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>

namespace talus::service {
namespace {

using std::chrono::duration_cast;
using std::chrono::milliseconds;

constexpr milliseconds glance{250};  ///< interval between checks for shutdown
constexpr milliseconds linger{500};
constexpr milliseconds idle_limit{5000};    ///< between two requests
constexpr milliseconds write_limit{20000};  ///< for the client to accept the response

const BadRequest too_slow{408, "the request was not received completely in time"};

}  // namespace

bool Connection::wait_for(short events, Clock::time_point deadline) const {
  for (;;) {
    const auto left = duration_cast<milliseconds>(deadline - Clock::now());
    if (left.count() <= 0) return false;
    pollfd one{fd_.get(), events, 0};
    const int ready = ::poll(&one, 1, static_cast<int>(std::min(left, glance).count()));
    if (ready > 0) return true;
    if (ready < 0 && errno != EINTR) return false;
    if (stopping_ && stopping_()) return false;
  }
}

Connection::Got Connection::receive(Clock::time_point deadline) {
  if (!wait_for(POLLIN, deadline)) return Got::nothing;
  char block[16384];
  const ssize_t got = ::recv(fd_.get(), block, sizeof block, MSG_DONTWAIT);
  if (got < 0 && (errno == EAGAIN || errno == EINTR)) return Got::bytes;  // none, but come again
  if (got <= 0) return Got::end;
  buffer_.append(block, static_cast<std::size_t>(got));
  return Got::bytes;
}

std::optional<WholeRequest> Connection::next() {
  const Clock::time_point idle = Clock::now() + idle_limit;
  while (buffer_.empty())
    if (receive(idle) != Got::bytes) return std::nullopt;
  while (buffer_.starts_with("\r\n")) buffer_.erase(0, 2);  // RFC 9112 2.2

  const Clock::time_point deadline = Clock::now() + request_limit_;
  std::optional<std::size_t> end;
  while (!(end = head_end(buffer_))) {
    if (buffer_.size() > limits_.head_bytes)
      throw BadRequest{431, "the request header is longer than " + std::to_string(limits_.head_bytes) + " bytes"};
    const Got got = receive(deadline);
    if (got == Got::end) return std::nullopt;
    if (got == Got::nothing) throw too_slow;
  }
  Head head = judge(std::string_view(buffer_).substr(0, *end), limits_);
  buffer_.erase(0, *end);
  if (head.expects_continue && buffer_.size() < head.body && !write("HTTP/1.1 100 Continue\r\n\r\n"))
    return std::nullopt;
  while (buffer_.size() < head.body) {
    const Got got = receive(deadline);
    if (got == Got::end) return std::nullopt;
    if (got == Got::nothing) throw too_slow;
  }
  WholeRequest request{.head = std::move(head), .body = buffer_.substr(0, head.body)};
  buffer_.erase(0, request.body.size());
  return request;
}

bool Connection::write(const char* data, std::size_t size) {
  const Clock::time_point deadline = Clock::now() + write_limit;
  while (size > 0) {
    const ssize_t sent = ::send(fd_.get(), data, size, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent > 0) {
      data += sent;
      size -= static_cast<std::size_t>(sent);
    } else if (sent < 0 && errno != EAGAIN && errno != EINTR) {
      return false;
    } else if (!wait_for(POLLOUT, deadline)) {
      return false;
    }
  }
  return true;
}

void Connection::finish() {
  ::shutdown(fd_.get(), SHUT_WR);
  const Clock::time_point deadline = Clock::now() + linger;
  for (std::size_t read = 0; read < (std::size_t{1} << 20); read += buffer_.size()) {
    buffer_.clear();
    if (receive(deadline) != Got::bytes) return;
  }
}

}  // namespace talus::service
