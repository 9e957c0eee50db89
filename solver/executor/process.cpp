#include "executor/process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

#include "support/files.hpp"

namespace talus::executor {
namespace {

namespace fs = std::filesystem;

/// posix_spawn's two attribute objects, freed together.
struct SpawnSetup {
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;

  SpawnSetup(const fs::path& out, const fs::path& err) {
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, out.c_str(), O_WRONLY | O_APPEND, 0);
    if (out == err)
      posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
    else
      posix_spawn_file_actions_addopen(&files, STDERR_FILENO, err.c_str(), O_WRONLY | O_APPEND, 0);
    posix_spawnattr_init(&attributes);
    sigset_t all, none;
    sigfillset(&all);
    sigemptyset(&none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
  }
  ~SpawnSetup() {
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
  }
  SpawnSetup(const SpawnSetup&) = delete;
  SpawnSetup& operator=(const SpawnSetup&) = delete;
};

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> all;
  for (std::string& text : texts) all.push_back(text.data());
  all.push_back(nullptr);
  return all;
}

/// Truncates the file first, so that a full disk is not mistaken for a missing program.
void create(const fs::path& path) {
  const FileDescriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  if (!file) throw_io_error("create", path, errno);
}

void limit(pid_t pid, __rlimit_resource what, std::uint64_t value) {
  const rlimit both{value, value};
  if (value > 0) ::prlimit(pid, what, &both, nullptr);
}

void set_limits(pid_t pid, const Limits& limits) {
  limit(pid, RLIMIT_AS, limits.memory_bytes);
  limit(pid, RLIMIT_CPU, limits.cpu_seconds);
  limit(pid, RLIMIT_FSIZE, limits.file_bytes);
  const rlimit none{0, 0};
  if (!limits.core_dumps) ::prlimit(pid, RLIMIT_CORE, &none, nullptr);
}

ProcessEnd decoded(int status) {
  if (WIFSIGNALED(status)) return {.signal = WTERMSIG(status)};
  return {.exit_code = WEXITSTATUS(status)};
}

}  // namespace

Process::Process(const Command& command, const fs::path& out, const fs::path& err) {
  create(out);
  if (out != err) create(err);
  const SpawnSetup setup(out, err);
  std::vector<std::string> arguments = command.arguments;
  std::vector<std::string> variables = command.environment.value_or(std::vector<std::string>{});
  const std::vector<char*> ours = pointers(variables);
  const int error = posix_spawnp(&pid_, arguments.front().c_str(), &setup.files, &setup.attributes,
                                 pointers(arguments).data(), command.environment ? ours.data() : environ);
  if (error != 0) {
    pid_ = -1;
    throw_io_error("start", command.arguments.front(), error);
  }
  set_limits(pid_, command.limits);
  if (command.niceness > 0) ::setpriority(PRIO_PROCESS, static_cast<id_t>(pid_), command.niceness);
}

Process::Process(Process&& other) noexcept : pid_(std::exchange(other.pid_, -1)), end_(other.end_) {}

Process::~Process() {
  if (pid_ < 0 || end_) return;
  signal(SIGKILL);
  int status = 0;
  while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
}

std::optional<ProcessEnd> Process::poll() {
  if (end_) return end_;
  int status = 0;
  if (::waitpid(pid_, &status, WNOHANG) == pid_) {
    end_ = decoded(status);
    ::kill(-pid_, SIGKILL);
  }
  return end_;
}

void Process::signal(int number) const {
  if (pid_ > 0 && !end_) ::kill(-pid_, number);
}

void Process::ask_to_end() const {
  signal(SIGTERM);
  signal(SIGCONT);
}

std::string signal_text(int number) {
  return std::string(::strsignal(number)) + " (signal " + std::to_string(number) + ")";
}

std::string tail(const fs::path& path, std::size_t max_bytes) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) return {};
  const auto size = static_cast<std::size_t>(file.tellg());
  const std::size_t wanted = std::min(size, max_bytes);
  std::string text(wanted, '\0');
  file.seekg(static_cast<std::streamoff>(size - wanted));
  file.read(text.data(), static_cast<std::streamsize>(wanted));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

std::string last_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r' || text.back() == ' ')) text.pop_back();
  const std::size_t start = text.find_last_of('\n');
  return start == std::string::npos ? text : text.substr(start + 1);
}

}  // namespace talus::executor
