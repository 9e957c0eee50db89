// Runs gnuplot: script on its stdin, picture on its stdout.

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "figures/sheet.hpp"
#include "support/error.hpp"

extern char** environ;

namespace talus::figures {
namespace {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

[[noreturn]] void fail(const std::string& what, int error) { throw IoError(what + ": " + std::strerror(error)); }

// A nameless file instead of a pipe: gnuplot may stop reading whenever it likes, and neither side can block the other.
File nameless_file(const std::string& content = {}) {
  File file(std::tmpfile(), std::fclose);
  if (!file) fail("cannot make a temporary file for gnuplot", errno);
  if (std::fwrite(content.data(), 1, content.size(), file.get()) != content.size() || std::fflush(file.get()) != 0)
    fail("cannot write the script for gnuplot", errno);
  std::rewind(file.get());
  return file;
}

std::string contents(std::FILE* file) {
  std::rewind(file);
  std::string text;
  char buffer[4096];
  for (std::size_t n; (n = std::fread(buffer, 1, sizeof buffer, file)) > 0;) text.append(buffer, n);
  return text;
}

}  // namespace

GnuplotOutput run_gnuplot(const std::string& script) {
  const File in = nameless_file(script), out = nameless_file(), err = nameless_file();
  posix_spawn_file_actions_t redirections;
  ::posix_spawn_file_actions_init(&redirections);
  ::posix_spawn_file_actions_adddup2(&redirections, ::fileno(in.get()), STDIN_FILENO);
  ::posix_spawn_file_actions_adddup2(&redirections, ::fileno(out.get()), STDOUT_FILENO);
  ::posix_spawn_file_actions_adddup2(&redirections, ::fileno(err.get()), STDERR_FILENO);
  // gnuplot 6 warns of a degree sign in the plain C locale.
  const char* arguments[] = {"env", "LC_ALL=C.UTF-8", "gnuplot", "--default-settings", nullptr};
  pid_t child = 0;
  const int error =
      ::posix_spawnp(&child, arguments[0], &redirections, nullptr, const_cast<char**>(arguments), environ);
  ::posix_spawn_file_actions_destroy(&redirections);
  if (error != 0 && error != ENOENT) fail("cannot start gnuplot", error);
  int status = 0;
  while (error == 0 && ::waitpid(child, &status, 0) < 0)
    if (errno != EINTR) fail("cannot wait for gnuplot", errno);
  constexpr int not_found = 127;  // env's exit status
  if (error == ENOENT || (WIFEXITED(status) && WEXITSTATUS(status) == not_found))
    throw IoError("gnuplot not found, so no figures were drawn; install gnuplot-nox");
  GnuplotOutput output{contents(out.get()), contents(err.get())};
  if (status != 0) throw IoError("gnuplot failed: " + output.warnings);
  return output;
}

}  // namespace talus::figures
