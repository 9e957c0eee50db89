#pragma once
// Files as Talus reads and leaves them: of bounded size, and whole or not at all. All functions are thread-safe.

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "support/error.hpp"

namespace talus {

/// Owns a POSIX file descriptor and closes it when it goes.
class FileDescriptor {
 public:
  explicit FileDescriptor(int fd = -1) : fd_(fd) {}
  FileDescriptor(FileDescriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~FileDescriptor() { close(); }

  int get() const { return fd_; }
  explicit operator bool() const { return fd_ >= 0; }
  /// Closes now; the return value and errno are those of ::close (a network file system may report a full disk here).
  int close() { return fd_ < 0 ? 0 : ::close(std::exchange(fd_, -1)); }

 private:
  int fd_;
};

/// Throws IoError "cannot <doing> <path>: <the system's reason>; <what to do about it>".
/// @param doing  a verb: "write", "create"
/// @param error  a value of errno
[[noreturn]] void throw_io_error(std::string_view doing, const std::filesystem::path& path, int error);

/// Writes a file so that a reader sees the old content or the new one, never a part: temporary file in the same
/// directory, fsync, rename, fsync of the directory.
/// @throws IoError naming the path; an old file is then untouched and the temporary is gone
void write_file_atomically(const std::filesystem::path& path, std::string_view content);

/// The same piece by piece: a new file beside `target`, which takes its name with commit() and is gone otherwise. For
/// one thread.
class AtomicFile {
 public:
  /// @throws IoError naming the target: it is not a regular file, or its directory cannot be written
  explicit AtomicFile(const std::filesystem::path& target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Appends; goes to the disk in blocks. @throws IoError
  void write(std::string_view content);
  /// fsync, rename, fsync of the directory. @throws IoError; an old file is then untouched
  void commit();

 private:
  void flush();

  std::filesystem::path target_, path_;
  FileDescriptor file_;
  std::string buffer_;
  bool renamed_ = false;
};

/// The content of a file of at most `max_bytes`.
/// @throws IoError naming the path: missing, unreadable, a directory, larger than that
std::string read_file(const std::filesystem::path& path, std::size_t max_bytes);
/// The same; nothing where there is no such file.
std::optional<std::string> find_file(const std::filesystem::path& path, std::size_t max_bytes);

/// Renames a file or directory and makes the new name durable.
/// @throws IoError
void rename_durably(const std::filesystem::path& from, const std::filesystem::path& to);

/// Bytes that may still be written where `path` lies; 0 where that is unknown.
std::uint64_t disk_left(const std::filesystem::path& path);

/// What came of asking for an advisory lock.
struct TriedLock {
  FileDescriptor file;    ///< the lock ends with it, however the process ends; empty where another process holds it
  bool supported = true;  ///< false: the file system has no locks; the file is open, and nothing is locked
};
/// Asks for the lock of a directory, or of a file, which is created if need be.
/// @param inherited  child processes hold the lock too
/// @throws IoError when the file cannot be opened
TriedLock try_lock(const std::filesystem::path& path, bool inherited);

/// Removes a directory with all in it. NFS may list what other machines put there half a minute late; until then the
/// directory is not empty, and that is waited for.
/// @throws IoError
void remove_directory(const std::filesystem::path& path);
/// The same without waiting: what a network file system does not release yet stays, and goes with the directory around
/// it.
void remove_what_goes(const std::filesystem::path& path);

}  // namespace talus
