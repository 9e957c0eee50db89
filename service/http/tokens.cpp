#include "http/tokens.hpp"

#include <strings.h>

#include <sstream>
#include <stdexcept>

#include "base/digest.hpp"
#include "http/text.hpp"
#include "support/files.hpp"

namespace talus::service {
namespace {

bool is_subject(const std::string& text) { return is_identifier(text, "._@-"); }

std::optional<Role> role_of(const std::string& word) {
  if (word == "submit") return Role::submit;
  if (word == "read") return Role::read;
  return std::nullopt;
}

}  // namespace

Tokens::Tokens(const std::filesystem::path& file) : wanted_(true) {
  const auto text = find_file(file, 1 << 20);
  if (!text) throw std::runtime_error("cannot open the tokens file " + file.string());
  std::istringstream lines(*text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::istringstream words(line.substr(0, line.find('#')));
    std::string role, subject, hash, rest;
    if (!(words >> role)) continue;
    words >> subject >> hash >> rest;
    const bool hex = hash.size() == 64 && hash.find_first_not_of("0123456789abcdef") == std::string::npos;
    if (!role_of(role) || !is_subject(subject) || !hex || !rest.empty())
      throw std::runtime_error(file.string() + ":" + std::to_string(number) +
                               ": not \"submit|read SUBJECT SHA256\"; talusd --new-token prints such a line");
    entries_.emplace_back(hash, Bearer{subject, *role_of(role)});
  }
  if (entries_.empty()) throw std::runtime_error(file.string() + " contains no token");
}

std::optional<Bearer> Tokens::find(const std::string& authorization) const {
  constexpr std::string_view scheme = "bearer ";
  if (::strncasecmp(authorization.c_str(), scheme.data(), scheme.size()) != 0) return std::nullopt;
  const std::size_t begin = authorization.find_first_not_of(' ', scheme.size());
  if (begin == std::string::npos) return std::nullopt;
  const std::string hash = sha256(std::string_view(authorization).substr(begin));
  std::optional<Bearer> found;
  for (const auto& [known, bearer] : entries_)  // all of them, so that the time does not depend on which one matches
    if (equal_in_constant_time(known, hash)) found = bearer;
  return found;
}

std::pair<std::string, std::string> new_token(const std::string& role, const std::string& subject) {
  if (!role_of(role) || !is_subject(subject))
    throw std::runtime_error("--new-token needs a role (submit or read) and a subject of letters, digits and . _ @ -");
  const std::string token = random_hex(32);
  return {token, role + " " + subject + " " + sha256(token)};
}

}  // namespace talus::service
