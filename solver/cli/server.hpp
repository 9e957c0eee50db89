#pragma once
// Client of a talusd, for the remote subcommands.

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

namespace talus::cli {

/// URL and token.
struct ServerOptions {
  std::string url;         ///< --server, else TALUS_SERVER, else the default address of talusd
  std::string token_file;  ///< --token-file; else TALUS_TOKEN holds the token itself
};
void add_server_options(CLI::App& verb, ServerOptions& options);

class TalusServer {
 public:
  explicit TalusServer(const ServerOptions& options);
  ~TalusServer();

  /// What it answers, if that is a success.
  /// @throws ConfigError with the server's faults when it refuses what we sent, IoError for everything else
  nlohmann::ordered_json get(const std::string& path);
  nlohmann::ordered_json post(const std::string& path, const nlohmann::ordered_json& body);
  nlohmann::ordered_json remove(const std::string& path);

 private:
  class Connection;
  std::unique_ptr<Connection> connection_;
};

}  // namespace talus::cli
