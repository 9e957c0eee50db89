#pragma once
// Files as the service leaves them: whole or not at all.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace talus::service {

/// A file or directory could not be read or written.
struct FileError : std::runtime_error {
  using std::runtime_error::runtime_error;
  int error = 0;  ///< errno
};

/// @param doing  a verb: "write", "create"
[[noreturn]] void throw_file_error(const std::string& doing, const std::filesystem::path& path, int error);

/// A file descriptor with an owner.
class Descriptor {
 public:
  explicit Descriptor(int fd = -1) : fd_(fd) {}
  ~Descriptor();
  Descriptor(Descriptor&& other) noexcept : fd_(other.release()) {}
  Descriptor& operator=(Descriptor&& other) noexcept;
  int get() const { return fd_; }
  explicit operator bool() const { return fd_ >= 0; }
  int release();

 private:
  int fd_;
};

/// By a temporary file beside it, fsync, rename, fsync of the directory.
/// @throws FileError
void write_file(const std::filesystem::path& path, std::string_view content);

/// Renames and makes it durable. @throws FileError
void rename_durably(const std::filesystem::path& from, const std::filesystem::path& to);

/// The content of a file of at most `max_bytes`; nothing where there is none.
/// @throws FileError when it cannot be read or is larger
std::optional<std::string> read_file(const std::filesystem::path& path, std::size_t max_bytes);

/// Bytes that may still be written where `path` lies; 0 where nobody knows.
std::uint64_t disk_left(const std::filesystem::path& path);

/// Takes the lock of a file, which is created; empty where another process holds it. Gone with the descriptor, however
/// the process ends.
/// @param inherited  by child processes, which then hold it too
/// @throws FileError
Descriptor try_lock(const std::filesystem::path& path, bool inherited);

}  // namespace talus::service
