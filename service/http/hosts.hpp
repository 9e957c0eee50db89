#pragma once
// The names of this service, and which web pages may use it.
//
// A browser on any machine is in the middle: a page of another site can make it send requests here, by a name that it
// has let point here (DNS rebinding) or across sites. So only requests to known names are answered, and none that a
// page of another site has caused, with tokens or without, whatever the method and the type of content.

#include <set>
#include <string>
#include <string_view>

#include "http/guard.hpp"
#include "jobs/config.hpp"

namespace talus::service {

class Hosts {
 public:
  /// The names: loopback, the address of --listen, those of --host and --public-url; with tokens also this machine's.
  explicit Hosts(const Config& config);

  /// Checks Host, Origin and Sec-Fetch-Site, and replaces Host by a known name and the port.
  /// @param local_address  to which the client has connected: "192.0.2.1", "::1"
  /// @throws Refusal forbidden
  void check(Head& head, const std::string& local_address) const;

 private:
  std::string known(const std::string& host, const std::string& local_address) const;

  std::set<std::string> names_;
  std::string public_origin_;  ///< "https://talus.example.org"; empty: none
};

/// Whether only this machine can reach an address: "localhost", or an IP address of the loopback network.
bool is_loopback(const std::string& address);

}  // namespace talus::service
