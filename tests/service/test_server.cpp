// The server with handlers of a test: what a client gets, and what its handler is told.

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <condition_variable>
#include <future>
#include <mutex>
#include <thread>

#include "http/server.hpp"
#include "support/files.hpp"

namespace talus::service {
namespace {

using std::chrono::seconds;

/// A server on a free port, until the end of this object.
class Running {
 public:
  explicit Running(std::function<Admission(Incoming)> admit) : server_(make_server(config_, std::move(admit))) {
    port_ = server_->bind("127.0.0.1", 0);
    thread_ = std::thread([this] { server_->serve(); });
  }
  ~Running() { stop(); }
  void stop() {
    if (!thread_.joinable()) return;
    server_->stop();
    thread_.join();
  }

  FileDescriptor connect(const std::string& path) const {
    FileDescriptor client(::socket(AF_INET, SOCK_STREAM, 0));
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(port_));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(client.get(), reinterpret_cast<sockaddr*>(&to), sizeof to), 0);
    const std::string request = "GET " + path + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";
    EXPECT_EQ(::send(client.get(), request.data(), request.size(), 0), static_cast<ssize_t>(request.size()));
    return client;
  }

  /// The whole answer.
  std::string get(const std::string& path) const {
    const FileDescriptor client = connect(path);
    std::string answer;
    char block[4096];
    for (ssize_t got; (got = ::recv(client.get(), block, sizeof block, 0)) > 0;)
      answer.append(block, static_cast<std::size_t>(got));
    return answer;
  }

 private:
  Config config_;
  std::unique_ptr<Server> server_;
  int port_ = 0;
  std::thread thread_;
};

/// Waits until stop is requested, and notes that it was.
class Waiting {
 public:
  Answer operator()(const std::stop_token& stop) {
    begun_.set_value();
    std::mutex lock;
    std::condition_variable_any changed;
    std::unique_lock held(lock);
    changed.wait(held, stop, [] { return false; });
    stopped_.set_value();
    return {.body = "late"};
  }
  void wait_until_begun() { begun_.get_future().wait(); }
  void wait_until_stopped() { stopped_.get_future().wait(); }

 private:
  std::promise<void> begun_, stopped_;
};

Admission waiting(Waiting& handler, seconds limit) {
  return {.handle = [&handler](const std::string&, std::stop_token stop) { return handler(stop); },
          .lane = Lane::waiting,
          .limit = limit};
}

TEST(Server, TheTimeForAnAnswerEndsTheWork) {
  Waiting handler;
  const Running server([&](const Incoming&) { return waiting(handler, seconds(1)); });
  const std::string answer = server.get("/");
  EXPECT_TRUE(answer.starts_with("HTTP/1.1 504 ")) << answer;
  EXPECT_EQ(answer.find("late"), std::string::npos);
  handler.wait_until_stopped();
}

TEST(Server, AClientThatLeavesEndsTheWork) {
  Waiting handler;
  const Running server([&](const Incoming&) { return waiting(handler, seconds(3600)); });
  {
    const FileDescriptor client = server.connect("/");
    handler.wait_until_begun();
  }
  handler.wait_until_stopped();
}

TEST(Server, ItsEndEndsTheWork) {
  Waiting handler;
  Running server([&](const Incoming&) { return waiting(handler, seconds(3600)); });
  const FileDescriptor client = server.connect("/");
  handler.wait_until_begun();
  server.stop();
  handler.wait_until_stopped();
}

TEST(Server, LivesWhenMemoryIsShort) {
  const Running server([](const Incoming& request) -> Admission {
    return {.handle = [path = request.path](const std::string&, const std::stop_token&) -> Answer {
      if (path == "/short") throw std::bad_alloc();
      return {.body = "fine"};
    }};
  });
  EXPECT_TRUE(server.get("/short").starts_with("HTTP/1.1 503 "));
  EXPECT_TRUE(server.get("/").ends_with("fine"));
}

TEST(Server, ABusyLaneKeepsNoOtherWaiting) {
  Waiting handler;
  const Running server([&](const Incoming& request) -> Admission {
    if (request.path == "/waiting") return waiting(handler, seconds(3600));
    return {.handle = [](const std::string&, const std::stop_token&) { return Answer{.body = "fine"}; },
            .lane = Lane::operation};
  });
  const FileDescriptor client = server.connect("/waiting");
  handler.wait_until_begun();
  EXPECT_TRUE(server.get("/").ends_with("fine"));
}

TEST(Server, AStreamEndsWithItsChunks) {
  const Running server([](const Incoming&) -> Admission {
    return {.handle = [](const std::string&, const std::stop_token&) -> Answer {
      return {.type = event_stream, .stream = [](const Sink& sink) {
                EXPECT_TRUE(sink("one"));
                EXPECT_TRUE(sink("three"));
              }};
    }};
  });
  EXPECT_TRUE(server.get("/").ends_with("\r\n\r\n3\r\none\r\n5\r\nthree\r\n0\r\n\r\n"));
}

}  // namespace
}  // namespace talus::service
