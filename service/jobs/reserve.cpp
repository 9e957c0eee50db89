#include "jobs/reserve.hpp"

#include <fcntl.h>

#include <cerrno>
#include <exception>

#include "queue/database.hpp"
#include "support/files.hpp"

namespace talus::service {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t reserve_bytes = std::uint64_t{4} << 20;  ///< several times what SQLite writes at once

bool means_full(int error) { return error == ENOSPC || error == EDQUOT; }

}  // namespace

void make_reserve(const DataDirectory& data) noexcept {
  std::error_code error;
  if (fs::file_size(data.reserve(), error) == reserve_bytes && !error) return;
  if (disk_left(data.root) < least_disk_bytes + reserve_bytes) return;
  const FileDescriptor file(::open(data.reserve().c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600));
  if (file && ::posix_fallocate(file.get(), 0, static_cast<off_t>(reserve_bytes)) == 0) return;
  fs::remove(data.reserve(), error);
}

bool release_reserve(const DataDirectory& data) noexcept {
  std::error_code error;
  return fs::remove(data.reserve(), error) && !error;
}

bool is_disk_full() {
  try {
    throw;
  } catch (const StorageError& e) {
    return e.disk_full;
  } catch (const IoError& e) {
    return means_full(e.error);
  } catch (const fs::filesystem_error& e) {
    return means_full(e.code().value());
  } catch (...) {
    return false;
  }
}

}  // namespace talus::service
