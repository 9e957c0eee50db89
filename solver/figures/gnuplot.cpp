#include "figures/gnuplot.hpp"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include "support/error.hpp"

extern char** environ;

namespace talus::figures {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

[[noreturn]] void fail(const std::string& what, int error) { throw IoError(what + ": " + std::strerror(error)); }

// A nameless file instead of a pipe: gnuplot may stop reading whenever it likes, and neither side can block the other.
File nameless_file() {
  File file(std::tmpfile());
  if (!file) fail("cannot make a temporary file for gnuplot", errno);
  return file;
}

File script_file(const std::string& script) {
  File file = nameless_file();
  if (std::fwrite(script.data(), 1, script.size(), file.get()) != script.size() || std::fflush(file.get()) != 0) {
    fail("cannot write the script for gnuplot", errno);
  }
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

class FileActions {
 public:
  FileActions() { ::posix_spawn_file_actions_init(&actions_); }
  ~FileActions() { ::posix_spawn_file_actions_destroy(&actions_); }
  FileActions(const FileActions&) = delete;
  FileActions& operator=(const FileActions&) = delete;
  void redirect(int from, int to) { ::posix_spawn_file_actions_adddup2(&actions_, to, from); }
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_;
};

/// Ours, but for a language whose letters are those of the scripts: gnuplot 6 warns of a degree sign in the plain C
/// locale.
std::vector<char*> environment_of_gnuplot() {
  static char letters[] = "LC_ALL=C.UTF-8";
  std::vector<char*> variables = {letters};
  for (char** variable = environ; *variable != nullptr; ++variable)
    if (std::strncmp(*variable, "LC_ALL=", 7) != 0) variables.push_back(*variable);
  variables.push_back(nullptr);
  return variables;
}

// Exit status of gnuplot as waitpid gives it.
int spawn_gnuplot(int in, int out, int err) {
  FileActions actions;
  actions.redirect(STDIN_FILENO, in);
  actions.redirect(STDOUT_FILENO, out);
  actions.redirect(STDERR_FILENO, err);
  char program[] = "gnuplot";
  char no_start_up_file[] = "--default-settings";
  char* arguments[] = {program, no_start_up_file, nullptr};
  pid_t child = 0;
  const int error = ::posix_spawnp(&child, program, actions.get(), nullptr, arguments, environment_of_gnuplot().data());
  if (error == ENOENT || error == EACCES)
    throw IoError("gnuplot not found, so no figures were drawn; install gnuplot-nox");
  if (error != 0) fail("cannot start gnuplot", error);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) fail("cannot wait for gnuplot", errno);
  }
  return status;
}

}  // namespace

GnuplotOutput run_gnuplot(const std::string& script) {
  const File in = script_file(script);
  const File out = nameless_file();
  const File err = nameless_file();
  const int status = spawn_gnuplot(::fileno(in.get()), ::fileno(out.get()), ::fileno(err.get()));
  GnuplotOutput output{contents(out.get()), contents(err.get())};
  if (status != 0) throw IoError("gnuplot failed: " + output.warnings);
  return output;
}

}  // namespace talus::figures
