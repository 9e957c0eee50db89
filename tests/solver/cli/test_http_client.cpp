// The client of talusd has a time limit for the whole reply; its other limits: tests/service/test_hostile_server.py.
#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <thread>

#include "cli/http_client.hpp"
#include "support/error.hpp"

namespace talus::cli {
namespace {

using boost::asio::ip::tcp;
using std::chrono::milliseconds;

/// Answers one connection with `begun`, and then with a byte each 100 ms until the client has gone.
class SlowServer {
 public:
  explicit SlowServer(std::string begun)
      : acceptor_(io_, tcp::endpoint(boost::asio::ip::address_v4::loopback(), 0)),
        thread_([this, begun = std::move(begun)] { serve(begun); }) {}
  ~SlowServer() { thread_.join(); }
  std::string url() const { return "http://127.0.0.1:" + std::to_string(acceptor_.local_endpoint().port()); }

 private:
  void serve(std::string piece) {
    tcp::socket socket = acceptor_.accept();
    boost::system::error_code error;
    for (; !error; piece = "a") {
      boost::asio::write(socket, boost::asio::buffer(piece), error);
      std::this_thread::sleep_for(milliseconds(100));
    }
  }

  boost::asio::io_context io_;
  tcp::acceptor acceptor_;
  std::thread thread_;
};

std::string what_fails(const std::string& begun) {
  const SlowServer server(begun);
  try {
    send_request(server.url(), {.method = "GET", .path = "/", .limit = std::chrono::seconds(1)});
    return "";
  } catch (const IoError& e) {
    return e.what();
  }
}

TEST(HttpClient, EndsWhereTheReplyTakesTooLong) {
  for (const std::string begun : {"HTTP/1.1 200 OK\r\nX: ", "HTTP/1.1 200 OK\r\nContent-Length: 60\r\n\r\n"})
    EXPECT_NE(what_fails(begun).find("has not answered completely within 1 s"), std::string::npos);
}

TEST(HttpClient, WaitsForASlowReply) {
  const SlowServer server("HTTP/1.1 200 OK\r\nContent-Length: 5\r\n\r\n");
  EXPECT_EQ(send_request(server.url(), {.method = "GET", .path = "/", .limit = std::chrono::seconds(60)}).body,
            "aaaaa");
}

TEST(HttpClient, WaitsTwoMinutesWhereNothingElseIsSaid) { EXPECT_EQ(HttpRequest{}.limit, std::chrono::minutes(2)); }

}  // namespace
}  // namespace talus::cli
