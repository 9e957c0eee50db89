#pragma once
// Tokens and their roles.

#include <filesystem>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/clock.hpp"
#include "http/message.hpp"

namespace talus::service {

/// Holder of a token.
struct Bearer {
  std::string subject;  ///< owns jobs
  Role role = Role::read;
};

/// A tokens file that cannot be used as it is: its content or its permissions are wrong.
struct TokensError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The tokens file: a line "ROLE SUBJECT SHA256-OF-THE-TOKEN [EXPIRES]" each, # for remarks; EXPIRES is a date-time of
/// RFC 3339, after which the token is not accepted. The tokens themselves are not stored. Thread-safe.
class Tokens {
 public:
  /// None are wanted.
  Tokens() = default;
  /// @throws TokensError naming file and line; also where every user of this machine may write the file
  /// @throws IoError where it cannot be read
  explicit Tokens(std::filesystem::path file, Clock clock = system_now);

  bool wanted() const { return !file_.empty(); }
  /// Reads the file again; what is wrong with it leaves the tokens as they are. @throws as the constructor
  void reload();
  /// @param authorization  the header: "Bearer TOKEN", or "Basic ..." with the token as the password (RFC 7617) and any
  /// user name; the scheme in any case (RFC 9110 11.1)
  std::optional<Bearer> find(const std::string& authorization) const;

 private:
  struct Entry {
    std::string hash;  ///< SHA-256 of the token, in hex
    Bearer bearer;
    std::optional<Milliseconds> expires;
  };
  static std::optional<Entry> read_line(const std::string& line);

  std::filesystem::path file_;
  Clock clock_;
  mutable std::mutex lock_;
  std::vector<Entry> entries_;
};

/// A new token and the line for the file.
/// @param expires  a date-time, or empty: never
/// @throws TokensError
std::pair<std::string, std::string> new_token(const std::string& role, const std::string& subject,
                                              const std::string& expires = "");

}  // namespace talus::service
