#include "http/server.hpp"

#include <httplib.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <atomic>
#include <cerrno>

#include "base/clock.hpp"
#include "http/guard.hpp"
#include "http/text.hpp"
#include "support/files.hpp"

namespace talus::service {
namespace {

using std::chrono::milliseconds;

constexpr int backlog = 1024;        ///< the library's own is 5
constexpr milliseconds glance{250};  ///< between checks for shutdown
constexpr milliseconds linger{500};
constexpr milliseconds idle_limit{5000};    ///< between two requests
constexpr milliseconds write_limit{20000};  ///< for the client to accept the response

const Refusal too_slow(reason::request_timeout, "the request was not received completely in time");

/// A complete, valid request.
struct WholeRequest {
  Head head;
  std::string body;
};

/// The socket of one client: complete requests in, bytes out, both with a time limit. Used by one thread at a time.
class Connection {
 public:
  /// @param request_limit  from the first byte of a request to its last
  /// @param stopping  the server is shutting down; looked at every 250 ms
  Connection(int fd, const GuardLimits& limits, milliseconds request_limit, const std::atomic<bool>& stopping)
      : fd_(fd), limits_(limits), request_limit_(request_limit), stopping_(stopping) {}

  /// @return nothing where the client has closed the connection or sends nothing any more
  /// @throws Refusal; where the next request begins is then unknown
  std::optional<WholeRequest> next() {
    const Clock::time_point idle = Clock::now() + idle_limit;
    while (buffer_.empty())
      if (receive(idle) != Got::bytes) return std::nullopt;
    while (buffer_.starts_with("\r\n")) buffer_.erase(0, 2);  // RFC 9112 2.2

    const Clock::time_point deadline = Clock::now() + request_limit_;
    std::optional<std::size_t> end;
    while (!(end = head_end(buffer_))) {
      if (buffer_.size() > limits_.head_bytes)
        throw Refusal(reason::headers_too_large,
                      "the request header is longer than " + std::to_string(limits_.head_bytes) + " bytes");
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

  /// Writes all bytes. @return false if the client is gone or too slow, or the server is stopping
  bool write(const char* data, std::size_t size) {
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
  bool write(const std::string& text) { return write(text.data(), text.size()); }

  /// Closes the sending side and keeps reading for a moment, so that the client receives the last response.
  void finish() {
    ::shutdown(fd_.get(), SHUT_WR);
    const Clock::time_point deadline = Clock::now() + linger;
    for (std::size_t read = 0; read < (std::size_t{1} << 20); read += buffer_.size()) {
      buffer_.clear();
      if (receive(deadline) != Got::bytes) return;
    }
  }

  int socket() const { return fd_.get(); }

 private:
  using Clock = std::chrono::steady_clock;
  enum class Got { bytes, nothing, end };

  Got receive(Clock::time_point deadline) {
    if (!wait_for(POLLIN, deadline)) return Got::nothing;
    char block[16384];
    const ssize_t got = ::recv(fd_.get(), block, sizeof block, MSG_DONTWAIT);
    if (got < 0 && (errno == EAGAIN || errno == EINTR)) return Got::bytes;  // none, but come again
    if (got <= 0) return Got::end;
    buffer_.append(block, static_cast<std::size_t>(got));
    return Got::bytes;
  }

  bool wait_for(short events, Clock::time_point deadline) const {
    for (;;) {
      const auto left = duration_cast<milliseconds>(deadline - Clock::now());
      if (left.count() <= 0) return false;
      pollfd one{fd_.get(), events, 0};
      const int ready = ::poll(&one, 1, static_cast<int>(std::min(left, glance).count()));
      if (ready > 0) return true;
      if (ready < 0 && errno != EINTR) return false;
      if (stopping_) return false;
    }
  }

  FileDescriptor fd_;
  const GuardLimits& limits_;
  milliseconds request_limit_;
  const std::atomic<bool>& stopping_;
  std::string buffer_;  ///< received, not yet returned
};

/// RFC 9110 8.6: no length where there can be no content (204), where it is not that of the content that was not sent
/// again (304), and where a stream has none. The library writes a head as one piece, and 0 for each of these.
std::string without_false_length(std::string_view head) {
  constexpr std::string_view none = "\r\nContent-Length: 0";
  std::string text(head);
  const std::size_t at = text.find(none);
  const std::string_view status = head.substr(std::min(head.size(), std::string_view("HTTP/1.1 ").size()), 3);
  const bool is_false = status == "204" || status == "304" || head.find(event_stream) != std::string_view::npos;
  if (is_false && at != std::string::npos) text.erase(at, none.size());
  return text;
}

/// One judged request as the library's stream: reads come from memory, writes go to the client. Without `override`:
/// which of these there are depends on the library's version.
class RequestStream : public httplib::Stream {
 public:
  RequestStream(Connection& connection, const WholeRequest& request)
      : connection_(connection), input_(request.head.rewritten + request.body) {}

  bool is_readable() const { return true; }
  bool is_writable() const { return true; }
  bool wait_readable() const { return true; }
  bool wait_writable() const { return true; }
  time_t duration() const { return 0; }

  ssize_t read(char* data, size_t size) {
    const std::size_t n = std::min(size, input_.size() - at_);
    input_.copy(data, n, at_);
    at_ += n;
    return static_cast<ssize_t>(n);
  }
  ssize_t write(const char* data, size_t size) {
    const std::string_view bytes(data, size);
    const bool good = begun_ ? connection_.write(data, size) : connection_.write(without_false_length(bytes));
    begun_ = true;
    return good ? static_cast<ssize_t>(size) : -1;
  }
  void get_remote_ip_and_port(std::string&, int&) const {}
  void get_local_ip_and_port(std::string&, int&) const {}
  socket_t socket() const { return connection_.socket(); }

 private:
  Connection& connection_;
  std::string input_;
  std::size_t at_ = 0;
  bool begun_ = false;  ///< the head has been written
};

Incoming incoming(const httplib::Request& request) {
  Incoming in{.method = request.method,
              .path = request.path,
              .query = {request.params.begin(), request.params.end()},
              .headers = {},
              .body = request.body};
  for (const auto& [name, value] : request.headers) {
    const std::string key = lower(name);
    std::string& slot = in.headers[key == lower(body_type_header) ? "content-type" : key];
    slot += slot.empty() ? value : ", " + value;  // RFC 9110 5.2
  }
  return in;
}

/// An HTTP/1.0 client (`chunked` is false) does not understand chunks: its stream ends with the connection.
void fill_stream(httplib::Response& response, const Answer& answer, bool chunked) {
  const auto pour = [stream = answer.stream](size_t, httplib::DataSink& sink) {
    stream([&sink](const std::string& piece) { return sink.write(piece.data(), piece.size()); });
    sink.done();
    return true;
  };
  if (chunked) return response.set_chunked_content_provider(answer.type, pour);
  response.set_header("Connection", "close");
  response.set_content_provider(answer.type, pour);
}

void fill(httplib::Response& response, Answer answer, bool chunked = true) {
  response.status = answer.status;
  response.set_header("Date", http_date(system_now()));
  response.set_header("X-Content-Type-Options", "nosniff");
  response.set_header("Accept-Ranges", "none");  // the library claims "bytes" for HEAD
  for (const auto& [name, value] : answer.headers) response.set_header(name, value);
  if (answer.type == event_stream) response.set_header("Cache-Control", "no-store");
  if (answer.stream) {
    fill_stream(response, answer, chunked);
  } else if (answer.status != 204 && answer.status != 304) {
    response.set_content(answer.body, answer.type);
  }
}

/// The response to a refusal of the guard.
std::string raw_problem(const Refusal& refusal) {
  const std::string text = problem(refusal, "").body;
  return "HTTP/1.1 " + std::to_string(refusal.reason.status) + " " + refusal.reason.title +
         "\r\nDate: " + http_date(system_now()) +
         "\r\nContent-Type: application/json\r\nContent-Length: " + std::to_string(text.size()) +
         "\r\nConnection: close\r\n\r\n" + text;
}

class GuardedServer final : public Server, private httplib::Server {
 public:
  GuardedServer(const Config& config, bool loopback_names_only, std::function<Answer(Incoming)> handle)
      : limits_{.body_bytes = config.body_bytes, .loopback_names_only = loopback_names_only},
        request_limit_(config.request_limit),
        handle_(std::move(handle)) {
    new_task_queue = [threads = config.http_threads] { return new httplib::ThreadPool(static_cast<size_t>(threads)); };
    set_payload_max_length(limits_.body_bytes + 1);
    set_socket_options([this](socket_t fd) {
      const int yes = 1;
      ::setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
      ::fcntl(fd, F_SETFD, FD_CLOEXEC);
      listening_ = fd;
    });
    const auto answer = [this](const httplib::Request& request, httplib::Response& response) {
      fill(response, handle_(incoming(request)), request.version != "HTTP/1.0");
    };
    const std::string any = R"([\s\S]*)";
    Get(any, answer);
    Post(any, answer);
    Put(any, answer);
    Patch(any, answer);
    Delete(any, answer);
    Options(any, answer);
    // Methods that the library parses but does not dispatch: TRACE, CONNECT.
    set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      if (request.method != "TRACE" && request.method != "CONNECT" && request.method != "PRI")
        return HandlerResponse::Unhandled;
      fill(response, handle_(incoming(request)));
      return HandlerResponse::Handled;
    });
    set_error_handler([](const httplib::Request& request, httplib::Response& response) {
      if (!response.body.empty() || response.status < 400) return;
      Reason reason = response.status < 500 ? reason::bad_request : reason::internal;
      reason.status = response.status;
      fill(response, problem(Refusal(reason, reason.title), request.get_header_value("Accept")));
    });
  }

  int bind(const std::string& address, int port) override {
    const int bound = port == 0 ? bind_to_any_port(address) : bind_to_port(address, port) ? port : 0;
    if (bound > 0) ::listen(listening_, backlog);
    return bound > 0 ? bound : 0;
  }
  void serve() override {
    listen_after_bind();
    ended_ = true;
  }
  /// The library forgets a stop() that comes before it has begun to listen.
  void stop() override {
    stopping_ = true;
    while (!is_running() && !ended_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    httplib::Server::stop();
  }

 private:
  bool process_and_close_socket(socket_t fd) override {
    ::fcntl(fd, F_SETFD, FD_CLOEXEC);
    const int yes = 1;
    ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    Connection connection(fd, limits_, request_limit_, stopping_);
    try {
      for (bool more = true; more && !stopping_;) {
        const std::optional<WholeRequest> request = connection.next();
        if (!request) return true;
        RequestStream stream(connection, *request);
        more = serve_one(*this, stream, !request->head.keep_alive || stopping_) && request->head.keep_alive;
      }
    } catch (const Refusal& refusal) {
      log_info("refused", {{"status", refusal.reason.status}, {"why", refusal.what()}});
      connection.write(raw_problem(refusal));
    }
    connection.finish();
    return true;
  }

  /// process_request() has got more parameters since 0.11.
  template <class Self>
  static bool serve_one(Self& self, httplib::Stream& stream, bool last) {
    bool closed = false;
    if constexpr (requires { self.process_request(stream, last, closed, nullptr); })
      return self.process_request(stream, last, closed, nullptr) && !closed;
    else
      return self.process_request(stream, std::string(), 0, std::string(), 0, last, closed, nullptr) && !closed;
  }

  GuardLimits limits_;
  std::chrono::milliseconds request_limit_;
  std::function<Answer(Incoming)> handle_;
  socket_t listening_ = INVALID_SOCKET;
  std::atomic<bool> stopping_{false}, ended_{false};
};

}  // namespace

std::unique_ptr<Server> make_server(const Config& config, bool loopback_names_only,
                                    std::function<Answer(Incoming)> handle) {
  return std::make_unique<GuardedServer>(config, loopback_names_only, std::move(handle));
}

}  // namespace talus::service
