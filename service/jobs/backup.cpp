#include "jobs/backup.hpp"

#include <fcntl.h>

#include "queue/copy.hpp"
#include "study/run_key.hpp"
#include "support/files.hpp"
#include "support/output_directory.hpp"

namespace talus::service {
namespace {

namespace fs = std::filesystem;

/// What another process may remove at any time: working directories, locks and files that are being written.
bool passes(const fs::path& path, const StudyPaths& job) {
  return path == job.work() || is_output_lock(path) || is_temporary(path);
}

/// Copies a directory of a job; what goes meanwhile is left out.
void copy_directory(const fs::path& from, const fs::path& to, const StudyPaths& job, BackupReport& report) {
  fs::create_directories(to);
  std::error_code gone;
  for (const auto& entry : fs::directory_iterator(from, gone)) {
    if (passes(entry.path(), job)) continue;
    const fs::path target = to / entry.path().filename();
    const fs::file_status status = entry.symlink_status(gone);
    if (fs::is_directory(status)) copy_directory(entry.path(), target, job, report);
    if (!fs::is_regular_file(status)) continue;
    std::error_code error;
    fs::copy_file(entry.path(), target, error);
    if (error == std::errc::no_such_file_or_directory) continue;
    if (error) throw_io_error("write", target, error.value());
    ++report.files;
    report.bytes += fs::file_size(target);
  }
}

void require_empty(const fs::path& target) {
  if (!fs::exists(target)) return;
  if (!fs::is_directory(target) || !fs::is_empty(target))
    throw IoError(target.string() + " exists and is not an empty directory; choose another one for the backup");
}

/// Waits until all that was written to the file system of a directory is on the disk.
void sync_file_system(const fs::path& directory) {
  const FileDescriptor fd(::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!fd || ::syncfs(fd.get()) != 0) throw_io_error("write", directory, errno);
}

}  // namespace

BackupReport back_up(const DataDirectory& data, const fs::path& target) {
  if (!fs::exists(data.database())) throw IoError("there is no queue in " + data.root.string());
  require_empty(target);
  const DataDirectory copy{target};
  fs::create_directories(copy.jobs());
  const fs::path queue = fs::path(copy.database()).concat(".incomplete");
  copy_queue(data.database(), queue);
  BackupReport report;
  const std::set<std::string> studies = studies_in(queue, false);
  for (const std::string& id : studies) {
    copy_directory(data.job(id), copy.job(id), {data.job(id)}, report);
    ++report.jobs;
  }
  // A job that was dismissed meanwhile may have lost files before they were copied.
  std::set<std::string> dismissed;
  for (const std::string& id : studies_in(data.database(), true))
    if (studies.contains(id)) dismissed.insert(id);
  dismiss_jobs(queue, dismissed);
  for (const std::string& id : studies)
    if (!dismissed.contains(id) && !fs::exists(data.job(id))) report.missing.insert(id);
  rename_durably(queue, copy.database());
  sync_file_system(target);
  return report;
}

}  // namespace talus::service
