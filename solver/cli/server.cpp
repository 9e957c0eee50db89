#include "cli/server.hpp"

#include <httplib.h>

#include <cstdio>
#include <cstdlib>
#include <random>

#include "support/error.hpp"
#include "support/files.hpp"

namespace talus::cli {
namespace {

using nlohmann::ordered_json;

constexpr int connect_seconds = 5, read_seconds = 120;

std::string token(const ServerOptions& options) {
  const char* given = std::getenv("TALUS_TOKEN");
  std::string text = options.token_file.empty() ? (given ? given : "") : read_file(options.token_file, 4096);
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
  return text;
}

std::string not_a_url(const std::string& text) {
  return "--server " + text + " is not a URL such as http://127.0.0.1:8080";
}

/// The library throws at schemes that it does not know.
std::string checked(const std::string& url) {
  if (!url.starts_with("http://") && !url.starts_with("https://")) throw ConfigError("", not_a_url(url));
  return url.back() == '/' ? url.substr(0, url.size() - 1) : url;
}

/// Sent again after a broken connection, a request with the same key makes no second job.
std::string new_key() {
  std::random_device entropy;
  char text[40];
  std::snprintf(text, sizeof text, "talus-%08x%08x%08x", entropy(), entropy(), entropy());
  return text;
}

}  // namespace

class TalusServer::Connection {
 public:
  explicit Connection(const ServerOptions& options) : url(checked(options.url)), client(url) {
    if (!client.is_valid()) throw ConfigError("", not_a_url(url));
    client.set_connection_timeout(connect_seconds);
    client.set_read_timeout(read_seconds);
    if (const std::string secret = token(options); !secret.empty())
      headers.emplace("Authorization", "Bearer " + secret);
  }

  ordered_json answer(const httplib::Result& result) const {
    if (!result)
      throw IoError("cannot reach " + url + ": " + httplib::to_string(result.error()) +
                    "; check that talusd is running there and that the URL is right");
    const ordered_json body = ordered_json::parse(result->body, nullptr, false);
    if (body.is_discarded()) throw IoError(url + " answered, but not as talusd; check the URL");
    if (result->status < 300) return body;
    const std::string detail = body.value("detail", "status " + std::to_string(result->status));
    std::vector<Fault> faults;
    if (body.contains("errors"))
      for (const auto& error : body.at("errors"))
        faults.push_back({error.value("pointer", ""), error.value("message", "")});
    if (result->status == 400 || result->status == 422) {
      if (faults.empty()) faults.push_back({"", detail});
      throw ConfigError(faults);
    }
    throw IoError("talusd at " + url + ": " + detail);
  }

  std::string url;
  httplib::Client client;
  httplib::Headers headers;
};

void add_server_options(CLI::App& verb, ServerOptions& options) {
  options.url = "http://127.0.0.1:8080";
  verb.add_option("--server", options.url, "URL of the talusd server")
      ->type_name("URL")
      ->envname("TALUS_SERVER")
      ->capture_default_str();
  verb.add_option("--token-file", options.token_file, "File with the token; default: $TALUS_TOKEN, if set")
      ->type_name("FILE");
}

TalusServer::TalusServer(const ServerOptions& options) : connection_(std::make_unique<Connection>(options)) {}
TalusServer::~TalusServer() = default;

ordered_json TalusServer::get(const std::string& path) {
  return connection_->answer(connection_->client.Get(path, connection_->headers));
}

ordered_json TalusServer::post(const std::string& path, const ordered_json& body) {
  httplib::Headers headers = connection_->headers;
  headers.emplace("Idempotency-Key", new_key());
  const std::string text = body.dump();
  auto result = connection_->client.Post(path, headers, text, "application/json");
  if (!result) result = connection_->client.Post(path, headers, text, "application/json");
  return connection_->answer(result);
}

ordered_json TalusServer::remove(const std::string& path) {
  return connection_->answer(connection_->client.Delete(path, connection_->headers));
}

}  // namespace talus::cli
