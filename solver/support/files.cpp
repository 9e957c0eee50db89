#include "support/files.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/statvfs.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <system_error>
#include <thread>

namespace talus {
namespace {

namespace fs = std::filesystem;

/// What a person can do about an error of the system; empty where its text says it all.
std::string advice(int error) {
  switch (error) {
    case ENOSPC:
    case EDQUOT:
      return "free some space or choose another disk";
    case EFBIG:
      return "raise the limit of file size (ulimit -f)";
    case EACCES:
    case EPERM:
    case EROFS:
      return "choose a place that you may read and write";
    case ENOENT:
      return "check the path";
    case ENOTDIR:
      return "a part of the path is a file, not a directory";
    case EMFILE:
    case ENFILE:
      return "raise the limit of open files (ulimit -n)";
    default:
      return "";
  }
}

fs::path directory_of(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

void sync_directory(const fs::path& directory) {
  const FileDescriptor fd(::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (fd) ::fsync(fd.get());  // the file itself is safe; some file systems cannot sync a directory
}

/// A network file system lists what is gone, and keeps what another process has open, under another name.
bool may_pass(const std::error_code& error) {
  return error == std::errc::directory_not_empty || error == std::errc::device_or_resource_busy;
}

}  // namespace

void throw_io_error(std::string_view doing, const fs::path& path, int error) {
  const std::string todo = advice(error);
  IoError thrown("cannot " + std::string(doing) + " " + path.string() + ": " + std::generic_category().message(error) +
                 (todo.empty() ? "" : "; " + todo));
  thrown.error = error;
  throw thrown;
}

AtomicFile::AtomicFile(const fs::path& target) : target_(target) {
  // A rename would put a file in the place of /dev/null just as well.
  struct stat old {};
  if (::stat(target.c_str(), &old) == 0 && !S_ISREG(old.st_mode))
    throw IoError("cannot write " + target.string() + ": it exists and is not a regular file; choose another name");
  static std::atomic<unsigned> counter{0};
  do {
    path_ = directory_of(target) /
            ("." + target.filename().string() + ".tmp-" + std::to_string(::getpid()) + "-" + std::to_string(counter++));
    file_ = FileDescriptor(::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  } while (!file_ && errno == EEXIST);
  if (!file_) throw_io_error("write", target_, errno);
}

AtomicFile::~AtomicFile() {
  if (!renamed_) ::unlink(path_.c_str());
}

void AtomicFile::write(std::string_view content) {
  constexpr std::size_t block = std::size_t{1} << 20;
  buffer_ += content;
  if (buffer_.size() >= block) flush();
}

void AtomicFile::flush() {
  for (std::string_view rest = buffer_; !rest.empty();) {
    const ssize_t written = ::write(file_.get(), rest.data(), rest.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw_io_error("write", target_, errno);
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
  buffer_.clear();
}

void AtomicFile::commit() {
  flush();
  while (::fsync(file_.get()) != 0)
    if (errno != EINTR) throw_io_error("write", target_, errno);
  if (file_.close() != 0) throw_io_error("write", target_, errno);
  rename_durably(path_, target_);
  renamed_ = true;
}

void write_file_atomically(const fs::path& path, std::string_view content) {
  AtomicFile file(path);
  file.write(content);
  file.commit();
}

std::optional<std::string> find_file(const fs::path& path, std::size_t max_bytes) {
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file && errno == ENOENT) return std::nullopt;
  if (!file) throw_io_error("read", path, errno);
  std::string content;
  char block[1 << 16];
  for (;;) {
    const ssize_t got = ::read(file.get(), block, sizeof block);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw_io_error("read", path, errno);
    if (got == 0) return content;
    content.append(block, static_cast<std::size_t>(got));
    if (content.size() > max_bytes)
      throw IoError("cannot read " + path.string() + ": it is larger than " + std::to_string(max_bytes) + " bytes");
  }
}

std::string read_file(const fs::path& path, std::size_t max_bytes) {
  std::optional<std::string> content = find_file(path, max_bytes);
  if (!content) throw_io_error("read", path, ENOENT);
  return std::move(*content);
}

void rename_durably(const fs::path& from, const fs::path& to) {
  if (::rename(from.c_str(), to.c_str()) != 0) throw_io_error("write", to, errno);
  sync_directory(directory_of(to));
}

std::uint64_t disk_left(const fs::path& path) {
  struct statvfs info {};
  return ::statvfs(path.c_str(), &info) == 0 ? std::uint64_t{info.f_bavail} * info.f_frsize : 0;
}

TriedLock try_lock(const fs::path& path, bool inherited) {
  const int how = fs::is_directory(path) ? O_RDONLY | O_DIRECTORY : O_RDWR | O_CREAT;
  FileDescriptor file(::open(path.c_str(), how | (inherited ? 0 : O_CLOEXEC), 0666));
  if (!file) throw_io_error("create", path, errno);
  for (;;) {
    if (::flock(file.get(), LOCK_EX | LOCK_NB) == 0) return {.file = std::move(file)};
    if (errno == EWOULDBLOCK) return {.file = FileDescriptor()};
    if (errno == ENOSYS || errno == EOPNOTSUPP || errno == ENOLCK || errno == EBADF)  // EBADF: a directory on NFS
      return {.file = std::move(file), .supported = false};
    if (errno != EINTR) throw_io_error("lock", path, errno);
  }
}

void remove_directory(const fs::path& path) {
  constexpr std::chrono::seconds patience{60};
  const auto end = std::chrono::steady_clock::now() + patience;
  for (;;) {
    std::error_code error;
    fs::remove_all(path, error);
    if (!error) return;
    if (!may_pass(error) || std::chrono::steady_clock::now() > end) throw_io_error("remove", path, error.value());
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
  }
}

void remove_what_goes(const fs::path& path) {
  std::error_code error;
  fs::remove_all(path, error);
  if (error && !may_pass(error)) throw_io_error("remove", path, error.value());
}

}  // namespace talus
