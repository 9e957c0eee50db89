#include "jobs/data_watch.hpp"

#include <sys/stat.h>

#include <cerrno>

#include "base/refusal.hpp"
#include "support/files.hpp"

namespace talus::service {

std::optional<DataWatch::Identity> DataWatch::identity(const std::filesystem::path& path) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0) return std::nullopt;
  return Identity{info.st_dev, info.st_ino};
}

DataWatch::DataWatch(const DataDirectory& data) {
  for (const auto& path : {data.root, data.jobs(), data.database()}) {
    const std::optional<Identity> found = identity(path);
    if (!found) throw_io_error("find", path, errno);
    known_.emplace_back(path, *found);
  }
}

void DataWatch::check() const {
  for (const auto& [path, known] : known_)
    if (identity(path) != known)
      throw Refusal(reason::unavailable, path.filename().string() +
                                             " of the data directory has been removed or replaced; nothing is "
                                             "accepted until talusd is started again");
}

}  // namespace talus::service
