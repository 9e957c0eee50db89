#pragma once
// Bearer tokens and their roles.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "http/message.hpp"

namespace talus::service {

/// Holder of a token.
struct Bearer {
  std::string subject;  ///< owns jobs
  Role role = Role::read;
};

/// The tokens file: a line "ROLE SUBJECT SHA256-OF-THE-TOKEN" each, # for remarks. The tokens themselves are not
/// stored.
class Tokens {
 public:
  Tokens() = default;
  /// @throws std::runtime_error naming file and line
  explicit Tokens(const std::filesystem::path& file);

  bool wanted() const { return wanted_; }
  /// @param authorization  the header: "Bearer ...", the scheme in any case (RFC 9110 11.1)
  std::optional<Bearer> find(const std::string& authorization) const;

 private:
  bool wanted_ = false;
  std::vector<std::pair<std::string, Bearer>> entries_;  ///< SHA-256 of the token, in hex
};

/// A new token and the line for the file.
std::pair<std::string, std::string> new_token(const std::string& role, const std::string& subject);

}  // namespace talus::service
