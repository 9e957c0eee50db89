#include "http/hosts.hpp"

#include <arpa/inet.h>
#include <unistd.h>

#include <array>

#include "http/text.hpp"

namespace talus::service {
namespace {

/// "name:80" or "[::1]:80", whose port may be missing.
struct Authority {
  std::string name;  ///< in lower case, without brackets
  std::string port;  ///< digits; empty: none
};

std::optional<Authority> read_authority(std::string_view text) {
  const std::size_t bracket = text.find(']'), colon = text.find(':', bracket == std::string_view::npos ? 0 : bracket);
  std::string_view name = text.substr(0, colon);
  const std::string_view port = colon == std::string_view::npos ? "" : text.substr(colon + 1);
  if (port.size() > 5 || port.find_first_not_of("0123456789") != std::string_view::npos) return std::nullopt;
  if (name.starts_with('[') && name.ends_with(']')) name = name.substr(1, name.size() - 2);
  return Authority{lower(name), std::string(port)};
}

/// "https://name:443" of a URL. @param url  with a scheme
std::string origin_of(const std::string& url) {
  const std::size_t begin = url.find("://");
  return begin == std::string::npos ? "" : lower(url.substr(0, url.find_first_of("/?#", begin + 3)));
}

std::string in_brackets(const std::string& name) {
  return name.find(':') == std::string::npos ? name : "[" + name + "]";
}

}  // namespace

Hosts::Hosts(const Config& config)
    : names_{"localhost", "127.0.0.1", "::1", lower(config.address)}, public_origin_(origin_of(config.public_url)) {
  for (const std::string& name : config.hosts) names_.insert(lower(name));
  if (!public_origin_.empty())
    if (const auto own = read_authority(std::string_view(public_origin_).substr(public_origin_.find("://") + 3)))
      names_.insert(own->name);
  std::array<char, 256> machine{};
  if (!config.tokens.empty() && ::gethostname(machine.data(), machine.size() - 1) == 0)
    names_.insert(lower(machine.data()));
}

/// The value of a Host header in its normal form. @throws Refusal
std::string Hosts::known(const std::string& host, const std::string& local_address) const {
  const auto wanted = read_authority(host);
  if (!wanted || (!names_.contains(wanted->name) && wanted->name != local_address))
    throw Refusal(reason::forbidden,
                  "this service does not answer under the host name of this request; talusd --host NAME adds one");
  return in_brackets(wanted->name) + (wanted->port.empty() ? "" : ":") + wanted->port;
}

void Hosts::check(Head& head, const std::string& local_address) const {
  Incoming& request = head.request;
  if (!head.replaced_host.empty()) known(head.replaced_host, local_address);
  std::string own;
  if (const std::string given = request.header("host"); !given.empty())
    own = request.headers["host"] = known(given, local_address);
  const std::string origin = request.header("origin"), site = request.header("sec-fetch-site");
  const bool ours =
      origin.empty() || origin == public_origin_ || origin == "http://" + own || origin == "https://" + own;
  if (!ours || site == "cross-site" || site == "same-site")
    throw Refusal(reason::forbidden, "cross-origin requests are rejected");
}

bool is_loopback(const std::string& address) {
  in_addr v4{};
  if (::inet_pton(AF_INET, address.c_str(), &v4) == 1) return (ntohl(v4.s_addr) >> 24) == 127;
  return address == "localhost" || address == "::1";
}

}  // namespace talus::service
