#include "http/server.hpp"

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <cerrno>
#include <functional>

#include "base/json.hpp"
#include "http/connection.hpp"

namespace talus::service {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;
using std::chrono::milliseconds;

constexpr int backlog = 1024, most_at_once = 64;
constexpr int spare_connections = most_at_once;  ///< beyond the limits, for the operator
constexpr milliseconds last_words{1000};         ///< for answers to be sent when the service has stopped
constexpr std::string_view no_room =
    "HTTP/1.1 503 Service Unavailable\r\nContent-Length: 0\r\nRetry-After: 2\r\nConnection: close\r\n\r\n";

constexpr std::size_t kinds_of_waiting = 3;  ///< for events and pauses, for fields, for runs; --max-streams of each
constexpr std::size_t spare_waiting = 16;    ///< threads for those that are refused or need not wait

/// With tokens nobody gets more than half of the places; without, all are one subject.
LaneLimits lane(std::size_t threads, std::size_t places, bool shared) {
  return {.threads = threads, .places = places, .places_each = shared ? places / 2 : places};
}

std::string text_of(const asio::ip::address& address) {
  if (address.is_v6() && address.to_v6().is_v4_mapped())
    return asio::ip::make_address_v4(asio::ip::v4_mapped, address.to_v6()).to_string();
  return address.to_string();
}

class AsioServer final : public Server {
 public:
  AsioServer(const Config& config, std::function<Admission(Incoming)> admit)
      : config_(config),
        lanes_(config),
        front_{.limits{.body_bytes = config.body_bytes},
               .hosts{Hosts(config)},
               .traffic_limit = config.traffic_bytes,
               .head_limit = config.request_limit,
               .admit{std::move(admit)},
               .lanes{lanes_}},
        acceptor_(io_),
        timer_(io_) {}

  int bind(const std::string& address, int port) override {
    error_code error;
    const auto found = tcp::resolver(io_).resolve(address, std::to_string(port), tcp::resolver::passive, error);
    for (auto at = found.begin(); !error && at != found.end(); ++at)
      if (listen_at(*at)) return acceptor_.local_endpoint().port();
    return 0;
  }

  void serve() override {
    const auto work = asio::make_work_guard(io_);
    accept();
    for (bool running = true; running;) try {
        io_.run();
        running = false;
      } catch (const std::exception& e) {  // memory is short: the connection concerned is lost, the others go on
        report(e);
      }
  }

  void stop() override {
    asio::post(io_, [this] {
      front_.stopping = true;
      error_code ignored;
      acceptor_.close(ignored);
      for (auto at = front_.connections.begin(); at != front_.connections.end();) (*at++)->stop();
    });
    for (WorkLane* one : {&lanes_.operation, &lanes_.request, &lanes_.production, &lanes_.waiting, &lanes_.large})
      one->join();
    asio::post(io_, [this] { finish(std::chrono::steady_clock::now() + last_words); });
  }

 private:
  bool listen_at(const tcp::endpoint& endpoint) {
    error_code error;
    acceptor_ = tcp::acceptor(io_);
    acceptor_.open(endpoint.protocol(), error);
    if (error) return false;
    ::fcntl(acceptor_.native_handle(), F_SETFD, FD_CLOEXEC);
    acceptor_.set_option(tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor_.non_blocking(true, error);
    if (!error) acceptor_.bind(endpoint, error);
    if (!error) acceptor_.listen(backlog, error);
    protocol_ = endpoint.protocol();
    return !error;
  }

  static void report(const std::exception& e) {
    try {
      log_error("connection", {{"why", e.what()}});
    } catch (const std::exception&) {  // not even memory for that
    }
  }

  void accept() {
    acceptor_.async_wait(tcp::acceptor::wait_read, [this](const error_code& error) {
      if (error) return;
      try {
        for (int i = 0; i < most_at_once && accept_one(); ++i) {
        }
      } catch (const std::exception& e) {
        report(e);
      }
      if (!front_.stopping) accept();
    });
  }

  /// With accept4, so that a worker that is being started at this moment does not inherit the socket.
  /// @return false where nobody waits
  bool accept_one() {
    const int fd = ::accept4(acceptor_.native_handle(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (fd < 0 && (errno == EMFILE || errno == ENFILE || errno == ENOMEM || errno == ENOBUFS))
      return front_.close_one([](const Connection&) { return true; });
    if (fd < 0) return errno == ECONNABORTED || errno == EINTR;
    tcp::socket socket(io_);
    error_code error;
    socket.assign(protocol_, fd, error);
    if (error) return ::close(fd) == 0;
    const tcp::endpoint remote = socket.remote_endpoint(error), local = socket.local_endpoint(error);
    if (error) return true;
    socket.set_option(tcp::no_delay(true), error);
    const std::string from = text_of(remote.address());
    const bool usual = has_room(from);
    if (usual || has_spare_room())
      std::make_shared<Connection>(front_, std::move(socket), from, text_of(local.address()), !usual)->start();
    else
      ::send(fd, no_room.data(), no_room.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    return true;
  }

  template <class Which>
  std::ptrdiff_t open_ones(Which which) const {
    return std::ranges::count_if(front_.connections,
                                 [&](const Connection* one) { return one->is_open() && std::invoke(which, *one); });
  }
  /// One that waits gives way to a new one.
  bool has_room(const std::string& address) {
    const auto usual = [](const Connection& one) { return !one.is_spare(); };
    const auto of_address = [&](const Connection& one) { return usual(one) && one.remote() == address; };
    if (open_ones(of_address) >= config_.connections_each && !front_.close_one(of_address)) return false;
    return open_ones(usual) < config_.connections || front_.close_one(usual);
  }
  bool has_spare_room() {
    return open_ones(&Connection::is_spare) < spare_connections || front_.close_one(&Connection::is_spare);
  }

  void finish(std::chrono::steady_clock::time_point end) {
    const bool writing = std::any_of(front_.connections.begin(), front_.connections.end(),
                                     [](const Connection* one) { return one->is_writing(); });
    if (!writing || std::chrono::steady_clock::now() > end) return io_.stop();
    timer_.expires_after(milliseconds(10));
    timer_.async_wait([this, end](const error_code&) { finish(end); });
  }

  const Config& config_;
  Lanes lanes_;
  Front front_;
  asio::io_context io_{1};
  tcp::acceptor acceptor_;
  tcp protocol_ = tcp::v4();
  asio::steady_timer timer_;
};

}  // namespace

Lanes::Lanes(const Config& config)
    : operation(lane(1, 128, false)),
      request(lane(static_cast<std::size_t>(config.http_threads), 512, !config.tokens.empty())),
      production(lane(16, 128, !config.tokens.empty())),
      waiting(lane(kinds_of_waiting * static_cast<std::size_t>(config.streams) + spare_waiting,
                   kinds_of_waiting * static_cast<std::size_t>(config.streams) + 128, !config.tokens.empty())),
      large(lane(1, 32, !config.tokens.empty())) {}

std::unique_ptr<Server> make_server(const Config& config, std::function<Admission(Incoming)> admit) {
  return std::make_unique<AsioServer>(config, std::move(admit));
}

}  // namespace talus::service
