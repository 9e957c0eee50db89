#pragma once
// A directory of results: claimed by one process at a time, and never made in a directory that holds other files.

#include <filesystem>
#include <optional>
#include <string>

#include "support/files.hpp"

namespace talus {

/// What a directory of results is for.
enum class OutputKind { run, study };

/// Which case results belong to.
struct CaseIdentity {
  std::string hash;                   ///< LoadedCase::hash
  std::string hash_without_end = {};  ///< LoadedCase::hash_without_end; empty: not recorded
  double end = 0.0;                   ///< simulated time at which a run ends [s]
  /// The same case, run to a later end.
  bool extends(const CaseIdentity& shorter) const {
    return hash != shorter.hash && !hash_without_end.empty() && hash_without_end == shorter.hash_without_end &&
           end > shorter.end;
  }
};

/// The marker file in a directory of results; it says that the directory is ours.
struct OutputMarker {
  OutputKind kind = OutputKind::run;
  CaseIdentity of;
  bool finished = false;  ///< everything has been written
};

/// The marker file of a directory.
std::filesystem::path output_marker_path(const std::filesystem::path& directory);
/// The marker of a directory, or nothing where there is none.
/// @throws IoError when there is one that cannot be read or is not ours
std::optional<OutputMarker> find_output_marker(const std::filesystem::path& directory);

/// The file that a directory of results is locked with.
bool is_output_lock(const std::filesystem::path& file);
/// What a write_file_atomically has not finished, or left when it was killed.
bool is_temporary(const std::filesystem::path& file);

/// A directory claimed for one run or study, for as long as the object lives.
///
/// It is created (parents too), or was empty, or carries our marker file `talus-output.json`. An advisory lock (flock
/// on `talus-output.lock`) keeps a second process out; on a file system without locks nothing does. The lock ends with
/// the process, however it ends. Who claims what an unfinished run or study of the same case left goes on with it.
class OutputDirectory {
 public:
  /// @param resume  accept a finished directory, also one of the same case with an earlier end
  /// @throws IoError naming the directory: it holds files that are not ours, another kind or another case, a finished
  /// run without `resume`, is in use by another process, or cannot be created or written
  OutputDirectory(std::filesystem::path path, OutputKind kind, const CaseIdentity& of, bool resume);

  const std::filesystem::path& path() const { return path_; }
  /// It holds the same case with an earlier end, as it was until reopen().
  bool extends() const { return earlier_end_.has_value(); }
  /// That earlier end [s].
  double earlier_end() const { return *earlier_end_; }
  /// Records the case with its later end, unfinished.
  void reopen();
  /// Everything has been written, by an earlier process or before mark_finished() returned.
  bool finished() const { return marker_.finished; }
  /// Records that everything has been written.
  void mark_finished();

 private:
  void write_marker() const;

  std::filesystem::path path_;
  OutputMarker marker_;
  std::optional<double> earlier_end_;
  FileDescriptor lock_;
};

}  // namespace talus
