#pragma once
// The command line and the configuration file of talusd.

#include <optional>
#include <string>
#include <vector>

#include "jobs/config.hpp"

namespace talus::service {

/// What main is to do.
struct Options {
  Config config;
  std::vector<std::string> new_token;  ///< role, subject: print a token and end
  std::optional<int> exit = {};        ///< end with this: help was asked for, or the usage is wrong
};

Options read_options(int argc, char** argv);

/// Whether only this machine can reach an address.
bool is_loopback(const std::string& address);

}  // namespace talus::service
