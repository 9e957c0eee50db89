#include "http/tokens.hpp"

#include <openssl/evp.h>
#include <strings.h>
#include <sys/stat.h>

#include <cerrno>
#include <sstream>

#include "base/digest.hpp"
#include "http/text.hpp"
#include "support/files.hpp"

namespace talus::service {
namespace {

constexpr std::size_t max_bytes = 1 << 20;

bool is_subject(const std::string& text) { return is_identifier(text, "._@-"); }

std::optional<Role> role_of(const std::string& word) {
  if (word == "submit") return Role::submit;
  if (word == "read") return Role::read;
  return std::nullopt;
}

/// What follows a scheme of RFC 9110 11.4; nothing where it is another one.
std::optional<std::string> credentials(const std::string& authorization, std::string_view scheme) {
  if (::strncasecmp(authorization.c_str(), scheme.data(), scheme.size()) != 0) return std::nullopt;
  if (authorization.size() <= scheme.size() || authorization[scheme.size()] != ' ') return std::nullopt;
  const std::size_t begin = authorization.find_first_not_of(' ', scheme.size());
  return begin == std::string::npos ? std::nullopt : std::optional(authorization.substr(begin));
}

/// RFC 4648 4; nothing where the text is not base64.
std::optional<std::string> from_base64(const std::string& text) {
  std::string out(text.size() / 4 * 3, '\0');
  const int size = EVP_DecodeBlock(reinterpret_cast<unsigned char*>(out.data()),
                                   reinterpret_cast<const unsigned char*>(text.data()), static_cast<int>(text.size()));
  if (size < 0 || text.size() % 4 != 0) return std::nullopt;
  const std::size_t padding = text.size() - (text.find_last_not_of('=') + 1);
  if (padding > 2) return std::nullopt;
  out.resize(static_cast<std::size_t>(size) - padding);
  return out;
}

/// The token that a client has sent.
std::optional<std::string> token_of(const std::string& authorization) {
  if (const auto token = credentials(authorization, "Bearer")) return token;
  const auto coded = credentials(authorization, "Basic");
  const auto pair = coded ? from_base64(*coded) : std::nullopt;
  const std::size_t colon = pair ? pair->find(':') : std::string::npos;
  return colon == std::string::npos ? std::nullopt : std::optional(pair->substr(colon + 1));
}

void check_permissions(const std::filesystem::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) throw_io_error("open the tokens file", file, errno);
  if ((status.st_mode & S_IWOTH) != 0)
    throw TokensError(file.string() + ": every user of this machine may write it; chmod o-w " + file.string());
}

}  // namespace

Tokens::Tokens(std::filesystem::path file, Clock clock) : file_(std::move(file)), clock_(std::move(clock)) { reload(); }

/// Nothing where the line is none.
std::optional<Tokens::Entry> Tokens::read_line(const std::string& line) {
  std::istringstream words(line);
  std::string role, subject, hash, expires, rest;
  words >> role >> subject >> hash >> expires >> rest;
  const bool hex = hash.size() == 64 && hash.find_first_not_of("0123456789abcdef") == std::string::npos;
  const auto end = expires.empty() ? std::nullopt : utc_time(expires);
  if (!role_of(role) || !is_subject(subject) || !hex || (!expires.empty() && !end) || !rest.empty())
    return std::nullopt;
  return Entry{hash, {subject, *role_of(role)}, end};
}

void Tokens::reload() {
  check_permissions(file_);
  const auto text = find_file(file_, max_bytes);
  if (!text) throw_io_error("open the tokens file", file_, ENOENT);
  std::istringstream lines(*text);
  std::vector<Entry> entries;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    line = line.substr(0, line.find('#'));
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const auto entry = read_line(line);
    if (!entry)
      throw TokensError(file_.string() + ":" + std::to_string(number) +
                        ": not \"submit|read SUBJECT SHA256 [2027-01-31T00:00:00Z]\"; talusd --new-token prints such a "
                        "line");
    entries.push_back(*entry);
  }
  if (entries.empty()) throw TokensError(file_.string() + " contains no token");
  const std::lock_guard lock(lock_);
  entries_.swap(entries);
}

std::optional<Bearer> Tokens::find(const std::string& authorization) const {
  const auto token = token_of(authorization);
  if (!token || token->empty()) return std::nullopt;
  const std::string hash = sha256(*token);
  const Milliseconds now = clock_();
  std::optional<Bearer> found;
  const std::lock_guard lock(lock_);
  for (const Entry& entry : entries_)  // all of them, so that the time does not depend on which one matches
    if (equal_in_constant_time(entry.hash, hash) && (!entry.expires || now < *entry.expires)) found = entry.bearer;
  return found;
}

std::pair<std::string, std::string> new_token(const std::string& role, const std::string& subject,
                                              const std::string& expires) {
  if (!role_of(role) || !is_subject(subject))
    throw TokensError("--new-token needs a role (submit or read) and a subject of letters, digits and . _ @ -");
  if (!expires.empty() && !utc_time(expires))
    throw TokensError(
        "--new-token: the third value is when the token expires: a date-time such as 2027-01-31T00:00:00Z");
  const std::string token = random_hex(32);
  return {token, role + " " + subject + " " + sha256(token) + (expires.empty() ? "" : " ") + expires};
}

}  // namespace talus::service
