#pragma once
// Files and directories as Talus leaves them: whole or not at all, and never on top of what is not ours.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "io/file_descriptor.hpp"

namespace talus {

/// Throws IoError "cannot <doing> <path>: <the system's reason>; <what to do about it>".
/// @param doing  a verb: "write", "create"
/// @param error  a value of errno
[[noreturn]] void throw_io_error(std::string_view doing, const std::filesystem::path& path, int error);

/// Writes a file so that a reader sees the old content or the new one, never a part: temporary file in the same
/// directory, fsync, rename, fsync of the directory.
/// @throws IoError naming the path; an old file is then untouched and the temporary is gone
void write_file_atomically(const std::filesystem::path& path, std::string_view content);

/// The content of a file of at most `max_bytes`.
/// @throws IoError naming the path: missing, unreadable, a directory, larger than that
std::string read_file(const std::filesystem::path& path, std::size_t max_bytes);

/// Removes a directory with all in it. NFS may list what other machines put there half a minute late; until then the
/// directory is not empty, and that is waited for.
/// @throws IoError
void remove_directory(const std::filesystem::path& path);
/// The same at once; what a network file system still holds stays, until the directory around it is removed.
void remove_what_goes(const std::filesystem::path& path);

/// What a directory of results is for.
enum class OutputKind { run, study };

/// The marker file in a directory of results; it says that the directory is ours.
struct OutputMarker {
  OutputKind kind = OutputKind::run;
  std::string case_hash;  ///< LoadedCase::hash
  bool finished = false;  ///< everything has been written
};

/// The marker of a directory, or nothing where there is none.
/// @throws IoError when there is one that cannot be read or is not ours
std::optional<OutputMarker> find_output_marker(const std::filesystem::path& directory);

/// A directory claimed for one run or study, for as long as the object lives.
///
/// It is created (parents too), or was empty, or carries our marker file `talus-output.json`. An advisory lock (flock
/// on `talus-output.lock`) keeps a second process out; on a file system without locks there is none. The lock ends with
/// the process, however it ends. A caller that starts over (resume = false) replaces what an unfinished run of the same
/// case left, and removes its checkpoint first.
class OutputDirectory {
 public:
  /// @param case_hash  LoadedCase::hash
  /// @param resume     accept a finished directory, and continue an unfinished one
  /// @throws IoError naming the directory: it holds files that are not ours, another kind or another case, a finished
  /// run without `resume`, is
  ///         in use by another process, or cannot be created or written
  OutputDirectory(std::filesystem::path path, OutputKind kind, const std::string& case_hash, bool resume);

  const std::filesystem::path& path() const { return path_; }
  /// An earlier process has begun here and `resume` was asked for.
  bool resumed() const { return resumed_; }
  /// Everything has been written, by an earlier process or before mark_finished() returned.
  bool finished() const { return marker_.finished; }
  /// Records that everything has been written.
  void mark_finished();

 private:
  void write_marker() const;

  std::filesystem::path path_;
  OutputMarker marker_;
  bool resumed_ = false;
  FileDescriptor lock_;
};

}  // namespace talus
