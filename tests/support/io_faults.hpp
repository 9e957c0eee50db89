#pragma once
// Ways to make input and output go wrong.

#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "support/error.hpp"

namespace talus::test {

/// The message of the IoError that `action` throws; fails the test when it throws none.
inline std::string io_error(const std::function<void()>& action) {
  try {
    action();
  } catch (const IoError& e) {
    return e.what();
  }
  ADD_FAILURE() << "no IoError";
  return "";
}

/// No file may grow beyond `bytes` as long as this lives.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    old_action_ = std::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &old_limit_);
    rlimit limit = old_limit_;
    limit.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &old_limit_);
    std::signal(SIGXFSZ, old_action_);
  }

 private:
  rlimit old_limit_{};
  void (*old_action_)(int);
};

/// A disk that only this process sees, in a chroot too: it is mounted nowhere.
class SmallDisk {
 public:
  explicit SmallDisk(const char* size) {
    const int kind = ::fsopen("tmpfs", FSOPEN_CLOEXEC);
    ::fsconfig(kind, FSCONFIG_SET_STRING, "size", size, 0);
    ::fsconfig(kind, FSCONFIG_CMD_CREATE, nullptr, nullptr, 0);
    disk_ = ::fsmount(kind, FSMOUNT_CLOEXEC, 0);
    ::close(kind);
  }
  ~SmallDisk() { ::close(disk_); }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  /// Whether there was the right to make one.
  bool exists() const { return disk_ >= 0; }
  std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(disk_); }

 private:
  int disk_ = -1;
};

/// Runs `action` in a process of its own and kills it with -9 after `time`.
inline void run_and_kill(std::chrono::milliseconds time, const std::function<void()>& action) {
  const pid_t child = ::fork();
  if (child == 0) {
    try {
      action();
    } catch (...) {
    }
    ::_exit(1);
  }
  std::this_thread::sleep_for(time);
  ::kill(child, SIGKILL);
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status)) << "the child should have worked until it was killed";
}

/// Names of the files in a directory, sorted.
inline std::vector<std::string> names_in(const std::filesystem::path& directory) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(directory))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace talus::test
