#include "http/server.hpp"

#include <httplib.h>
#include <netinet/tcp.h>

#include <atomic>

#include "base/clock.hpp"
#include "http/text.hpp"

namespace talus::service {
namespace {

constexpr int backlog = 1024;  ///< the library's own is 5

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

/// A refusal written without the library.
std::string raw_problem(const BadRequest& bad) {
  const std::string text = problem(bad.status, "", bad.why).body;
  return "HTTP/1.1 " + std::to_string(bad.status) + " " + status_text(bad.status) +
         "\r\nDate: " + http_date(system_now()) +
         "\r\nContent-Type: application/json\r\nContent-Length: " + std::to_string(text.size()) +
         "\r\nConnection: close\r\n\r\n" + text;
}

}  // namespace

class Server::Implementation : public httplib::Server {
 public:
  Implementation(const Config& config, bool loopback_names_only, std::function<Answer(Incoming)> handle)
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
      if (response.body.empty() && response.status >= 400)
        fill(response, problem(response.status, request.get_header_value("Accept")));
    });
  }

  int open(const std::string& address, int port) {
    const int bound = port == 0 ? bind_to_any_port(address) : bind_to_port(address, port) ? port : 0;
    if (bound > 0) ::listen(listening_, backlog);
    return bound > 0 ? bound : 0;
  }
  void run() {
    listen_after_bind();
    ended_ = true;
  }
  /// The library forgets a stop() that comes before it has begun to listen.
  void end() {
    stopping_ = true;
    while (!is_running() && !ended_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    stop();
  }

 private:
  bool process_and_close_socket(socket_t fd) override {
    ::fcntl(fd, F_SETFD, FD_CLOEXEC);
    const int yes = 1;
    ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    Connection connection(fd, limits_, request_limit_, [this] { return stopping_.load(); });
    try {
      for (bool more = true; more && !stopping_;) {
        const std::optional<WholeRequest> request = connection.next();
        if (!request) return true;
        RequestStream stream(connection, *request);
        more = serve_one(*this, stream, !request->head.keep_alive || stopping_) && request->head.keep_alive;
      }
    } catch (const BadRequest& bad) {
      log_info("refused", {{"status", bad.status}, {"why", bad.why}});
      connection.write(raw_problem(bad));
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

Server::Server(const Config& config, bool loopback_names_only, std::function<Answer(Incoming)> handle)
    : implementation_(std::make_unique<Implementation>(config, loopback_names_only, std::move(handle))) {}
Server::~Server() = default;
int Server::bind(const std::string& address, int port) { return implementation_->open(address, port); }
void Server::serve() { implementation_->run(); }
void Server::stop() { implementation_->end(); }

}  // namespace talus::service
