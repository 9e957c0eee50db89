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
  struct Entry {
    Bearer bearer;
    std::string hash;
  };
  bool wanted_ = false;
  std::vector<Entry> entries_;
};

/// A new token and the line for the file.
std::pair<std::string, std::string> new_token(const std::string& role, const std::string& subject);

}  // namespace talus::service
