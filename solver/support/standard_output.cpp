#include "support/standard_output.hpp"

#include <cerrno>
#include <cstdio>
#include <iostream>
#include <system_error>

#include "support/error.hpp"

namespace talus {

int checked_output(int code, const char* program) {
  errno = 0;
  std::cout.flush();
  const bool flushed = std::fflush(stdout) == 0;
  if (flushed && std::cout.good() && std::ferror(stdout) == 0) return code;
  const std::string why = errno != 0 ? ": " + std::generic_category().message(errno) : "";
  std::cerr << program << ": the output cannot be written" << why << "\n";
  return code == Exit::ok ? static_cast<int>(Exit::io) : code;
}

}  // namespace talus
