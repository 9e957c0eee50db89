#include "cli/http_client.hpp"

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/ssl.hpp>
#include <chrono>

#include "support/error.hpp"

namespace talus::cli {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using asio::ip::tcp;
using boost::system::error_code;

constexpr std::chrono::seconds connect_limit{5};

/// The connection broke, or could not be made.
struct Broken {
  error_code error;
  bool connected = true;
};

/// Runs one asynchronous operation to its end: only those know a time limit. @throws Broken
template <class Start>
void run(asio::io_context& io, Start start, bool connected = true) {
  error_code result = asio::error::would_block;
  start([&result](const error_code& error, auto&&...) { result = error; });
  io.restart();
  io.run();
  if (result) throw Broken{result, connected};
}

http::request<http::string_body> message_of(const HttpRequest& request, const ServerUrl& server) {
  http::request<http::string_body> message;
  message.method_string(request.method);
  message.target(request.path);
  message.version(11);
  const std::string host = server.host.find(':') == std::string::npos ? server.host : "[" + server.host + "]";
  message.set(http::field::host, host + ":" + server.port);
  message.set(http::field::user_agent, "talus");
  message.set(http::field::connection, "close");
  for (const auto& [name, value] : request.headers) message.set(name, value);
  message.body() = request.body;
  message.prepare_payload();
  return message;
}

/// @param stream  connected
template <class Stream>
HttpReply talk(asio::io_context& io, Stream& stream, const http::request<http::string_body>& message,
               std::chrono::seconds limit) {
  beast::get_lowest_layer(stream).expires_after(limit);  // for all that follows
  run(io, [&](auto done) { http::async_write(stream, message, std::move(done)); });
  beast::flat_buffer buffer;
  http::response_parser<http::string_body> parser;
  parser.header_limit(max_reply_head);
  parser.body_limit(max_reply_body);
  run(io, [&](auto done) { http::async_read_header(stream, buffer, parser, std::move(done)); });
  if (parser.content_length().value_or(0) > max_reply_body)  // before it makes room for so much
    throw Broken{make_error_code(http::error::body_limit)};
  run(io, [&](auto done) { http::async_read(stream, buffer, parser, std::move(done)); });
  return {static_cast<int>(parser.get().result_int()), std::move(parser.get().body())};
}

HttpReply exchange_once(const ServerUrl& server, const HttpRequest& request) {
  asio::io_context io;
  error_code error;
  const auto places = tcp::resolver(io).resolve(server.host, server.port, error);
  if (error) throw Broken{error, false};
  const auto message = message_of(request, server);
  const auto connect = [&](beast::tcp_stream& stream) {
    stream.expires_after(connect_limit);
    run(
        io, [&](auto done) { stream.async_connect(places, std::move(done)); }, false);
  };
  if (!server.tls) {
    beast::tcp_stream stream(io);
    connect(stream);
    return talk(io, stream, message, request.limit);
  }
  asio::ssl::context context(asio::ssl::context::tls_client);
  context.set_default_verify_paths(error);
  beast::ssl_stream<beast::tcp_stream> stream(io, context);
  stream.set_verify_mode(asio::ssl::verify_peer, error);
  stream.set_verify_callback(asio::ssl::host_name_verification(server.host), error);
  SSL_set_tlsext_host_name(stream.native_handle(), server.host.c_str());
  connect(beast::get_lowest_layer(stream));
  run(io, [&](auto done) { stream.async_handshake(asio::ssl::stream_base::client, std::move(done)); });
  return talk(io, stream, message, request.limit);
}

[[noreturn]] void throw_io_error(const std::string& url, std::chrono::seconds limit, const Broken& broken) {
  const auto bytes = [](std::size_t most, const char* what) {
    return " sends more than " + std::to_string(most >> 10) + " KiB as the " + what;
  };
  const std::string no_talusd = ": that is no talusd; check the URL";
  if (!broken.connected)
    throw IoError("cannot reach a talusd at " + url +
                  ": nothing answers there; start one, or give the URL of another one with --server or TALUS_SERVER");
  if (broken.error == http::error::header_limit) throw IoError(url + bytes(max_reply_head, "head") + no_talusd);
  if (broken.error == http::error::body_limit) throw IoError(url + bytes(max_reply_body, "body") + no_talusd);
  if (broken.error == beast::error::timeout)
    throw IoError(url + " has not answered completely within " + std::to_string(limit.count()) + " s; try again");
  if (broken.error.category() == http::make_error_code(http::error::bad_version).category() &&
      broken.error != http::error::end_of_stream && broken.error != http::error::partial_message)
    throw IoError(url + " answered, but not as talusd (" + broken.error.message() + "); check the URL");
  throw IoError("the connection to " + url + " broke (" + broken.error.message() + "); try again");
}

/// Nothing of the reply has come.
bool may_be_sent_again(const Broken& broken) {
  return broken.connected &&
         (broken.error == http::error::end_of_stream || broken.error == asio::error::connection_reset ||
          broken.error == asio::error::broken_pipe || broken.error == http::error::partial_message);
}

}  // namespace

ServerUrl read_server_url(const std::string& url) {
  const ConfigError wrong("", "--server " + url + " is not a URL such as http://127.0.0.1:8080");
  ServerUrl server{.tls = url.starts_with("https://")};
  if (!server.tls && !url.starts_with("http://")) throw wrong;
  std::string rest = url.substr(url.find("//") + 2);
  if (rest.ends_with('/')) rest.pop_back();
  const std::size_t bracket = rest.find(']'), colon = rest.find(':', bracket == std::string::npos ? 0 : bracket);
  server.host = rest.substr(0, colon);
  server.port = colon == std::string::npos ? (server.tls ? "443" : "80") : rest.substr(colon + 1);
  if (server.host.starts_with('[') && server.host.ends_with(']'))
    server.host = server.host.substr(1, server.host.size() - 2);
  const bool number = !server.port.empty() && server.port.find_first_not_of("0123456789") == std::string::npos &&
                      server.port.size() <= 5 && std::stoi(server.port) <= 65535;
  if (server.host.empty() || !number || server.host.find_first_of("/?#@ []\r\n") != std::string::npos) throw wrong;
  return server;
}

HttpReply send_request(const std::string& url, const HttpRequest& request) {
  const ServerUrl server = read_server_url(url);
  for (bool last : {request.method != "POST", true}) try {
      return exchange_once(server, request);
    } catch (const Broken& broken) {
      if (last || !may_be_sent_again(broken)) throw_io_error(url, request.limit, broken);
    }
  throw IoError(url + " does not answer");
}

}  // namespace talus::cli
