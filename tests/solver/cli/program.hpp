#pragma once
// Runs the program of this build, as a user would.

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "support/files.hpp"
#include "temporary_directory.hpp"

namespace talus::test {

struct Outcome {
  int code;  ///< exit code; 128 + signal if killed
  std::string out;
  std::string err;
};

/// An argument as the shell takes it literally.
inline std::string shell_quoted(const std::string& text) {
  std::string out(1, '\'');
  for (const char c : text) out.append(c == '\'' ? std::string("'\\''") : std::string(1, c));
  out += '\'';
  return out;
}

/// Runs `talus` with the arguments; `environment` ("PATH=/nonexistent") goes before it.
inline Outcome talus(const std::vector<std::string>& arguments, const std::string& environment = {}) {
  const TemporaryDirectory directory;
  std::string command = "env ";
  command.append(environment).append(" ").append(shell_quoted(TALUS_BINARY_DIR "/bin/talus"));
  for (const std::string& argument : arguments) command.append(" ").append(shell_quoted(argument));
  command.append(" >")
      .append(shell_quoted(directory / "out"))
      .append(" 2>")
      .append(shell_quoted(directory / "err"))
      .append(" </dev/null");
  const int status = std::system(command.c_str());
  constexpr std::size_t max_bytes = std::size_t{64} << 20;
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read_file(directory / "out", max_bytes),
          read_file(directory / "err", max_bytes)};
}

}  // namespace talus::test
