#pragma once
// A file that is written piece by piece and appears whole.

#include <filesystem>
#include <string>
#include <string_view>

#include "support/file_descriptor.hpp"

namespace talus {

/// A new file beside `target`, which takes its name with commit() and is gone otherwise. For one thread.
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

  std::filesystem::path target_;
  std::filesystem::path path_;
  FileDescriptor file_;
  std::string buffer_;
  bool renamed_ = false;
};

}  // namespace talus
