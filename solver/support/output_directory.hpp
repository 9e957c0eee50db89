#pragma once
// A directory of results: claimed by one process at a time, and never made in a directory that holds other files.

#include <filesystem>
#include <optional>
#include <string>

#include "support/files.hpp"

namespace talus {

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
/// on `talus-output.lock`) keeps a second process out; on a file system without locks nothing does. The lock ends with
/// the process, however it ends. A caller that starts over (resume = false) replaces what an unfinished run of the same
/// case left, and removes its checkpoint first.
class OutputDirectory {
 public:
  /// @param case_hash  LoadedCase::hash
  /// @param resume     accept a finished directory, and continue an unfinished one
  /// @throws IoError naming the directory: it holds files that are not ours, another kind or another case, a finished
  /// run without `resume`, is in use by another process, or cannot be created or written
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
