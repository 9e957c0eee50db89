#pragma once
// The command line and the configuration file of talusd.

#include <optional>
#include <string>
#include <vector>

#include "jobs/config.hpp"

namespace talus::service {

/// The task of main.
struct Options {
  Config config;
  bool adopt = false;                  ///< take jobs back from DATA/orphans and exit
  std::filesystem::path backup;        ///< copy the data directory to this one and exit
  std::vector<std::string> new_token;  ///< role, subject: print a token and exit
  std::optional<int> exit = {};        ///< exit with this code: help was requested, or the usage is wrong
};

Options read_options(int argc, char** argv);

}  // namespace talus::service
