#include "process/child.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <thread>
#include <utility>

#include "support/files.hpp"

namespace talus::service {
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

/// Nothing of ours but what a run needs; the last few decide only how it computes or reports.
std::vector<std::string> environment(int threads) {
  std::vector<std::string> all = {"PATH=/usr/local/bin:/usr/bin:/bin", "LANG=C.UTF-8", "TZ=UTC",
                                  "OMP_NUM_THREADS=" + std::to_string(threads), "OMP_WAIT_POLICY=passive"};
  for (const char* name : {"TALUS_SIMD", "ASAN_OPTIONS", "UBSAN_OPTIONS", "TSAN_OPTIONS"})
    if (const char* value = std::getenv(name)) all.push_back(std::string(name) + "=" + value);
  return all;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> all;
  for (std::string& text : texts) all.push_back(text.data());
  all.push_back(nullptr);
  return all;
}

void limit(pid_t pid, __rlimit_resource what, std::uint64_t value) {
  const rlimit both{value, value};
  if (value > 0) ::prlimit(pid, what, &both, nullptr);
}

constexpr std::size_t max_out_bytes = std::size_t{64} << 20;

void create(const fs::path& path) {
  const Descriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600));
  if (!file) throw_file_error("create", path, errno);
}

End decoded(int status) {
  if (WIFSIGNALED(status)) return {.signal = WTERMSIG(status)};
  return {.exit_code = WEXITSTATUS(status)};
}

}  // namespace

Child::Child(const Command& command, const fs::path& out, const fs::path& err) {
  create(out);  // here first, so that a full disk is not taken for a missing program
  if (out != err) create(err);
  const SpawnSetup setup(out, err);
  std::vector<std::string> arguments = command.arguments, variables = environment(command.threads);
  const int error = posix_spawn(&pid_, arguments.front().c_str(), &setup.files, &setup.attributes,
                                pointers(arguments).data(), pointers(variables).data());
  if (error != 0) {
    pid_ = -1;
    throw_file_error("start", command.arguments.front(), error);
  }
  limit(pid_, RLIMIT_AS, command.limits.memory_bytes);
  limit(pid_, RLIMIT_CPU, command.limits.cpu_seconds);
  limit(pid_, RLIMIT_FSIZE, command.limits.file_bytes);
  const rlimit no_core{0, 0};
  ::prlimit(pid_, RLIMIT_CORE, &no_core, nullptr);
  if (command.niceness > 0) ::setpriority(PRIO_PROCESS, static_cast<id_t>(pid_), command.niceness);
}

Child::Child(Child&& other) noexcept : pid_(std::exchange(other.pid_, -1)), end_(other.end_) {}

Child::~Child() {
  if (pid_ < 0 || end_) return;
  signal(SIGKILL);
  int status = 0;
  while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
}

std::optional<End> Child::poll() {
  if (end_) return end_;
  int status = 0;
  if (::waitpid(pid_, &status, WNOHANG) == pid_) {
    end_ = decoded(status);
    ::kill(-pid_, SIGKILL);  // what it may have left behind
  }
  return end_;
}

void Child::signal(int number) const {
  if (pid_ > 0 && !end_) ::kill(-pid_, number);
}

Outcome run_to_end(const Command& command, const fs::path& scratch, std::chrono::milliseconds limit,
                   const std::function<bool()>& give_up) {
  static std::atomic<unsigned> counter{0};
  const fs::path stem = scratch / ("command-" + std::to_string(::getpid()) + "-" + std::to_string(counter++));
  const fs::path out = stem.string() + ".out", err = stem.string() + ".err";
  struct Remover {
    const fs::path &a, &b;
    ~Remover() { ::unlink(a.c_str()), ::unlink(b.c_str()); }
  } const remover{out, err};

  Outcome outcome;
  Child child(command, out, err);
  const auto deadline = std::chrono::steady_clock::now() + limit;
  std::chrono::milliseconds nap{1};
  for (std::optional<End> end; !(end = child.poll()); std::this_thread::sleep_for(nap)) {
    if (!outcome.timed_out && (std::chrono::steady_clock::now() > deadline || (give_up && give_up()))) {
      outcome.timed_out = true;
      child.signal(SIGKILL);
    }
    nap = std::min(nap * 2, std::chrono::milliseconds(20));
  }
  outcome.end = *child.poll();
  outcome.out = read_file(out, max_out_bytes).value_or("");
  outcome.err = tail(err, 4000);
  return outcome;
}

std::string signal_text(int number) {
  return std::string(::strsignal(number)) + " (signal " + std::to_string(number) + ")";
}

}  // namespace talus::service
