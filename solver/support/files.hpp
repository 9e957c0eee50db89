#pragma once
// Files as Talus reads and leaves them: of bounded size, and whole or not at all. All functions are thread-safe.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "support/error.hpp"
#include "support/file_descriptor.hpp"

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
/// The same; nothing where there is no such file.
std::optional<std::string> find_file(const std::filesystem::path& path, std::size_t max_bytes);

/// Renames a file or directory and makes the new name durable.
/// @throws IoError
void rename_durably(const std::filesystem::path& from, const std::filesystem::path& to);

/// Bytes that may still be written where `path` lies; 0 where that is unknown.
std::uint64_t disk_left(const std::filesystem::path& path);

/// Takes the advisory lock of a file, which is created if need be. The lock ends with the descriptor, however the
/// process ends.
/// @param inherited  child processes hold the lock too
/// @return an empty descriptor where another process holds the lock
/// @throws IoError when the file cannot be opened, or the file system has no locks
FileDescriptor try_lock(const std::filesystem::path& path, bool inherited);

/// Removes a directory with all in it. NFS may list what other machines put there half a minute late; until then the
/// directory is not empty, and that is waited for.
/// @throws IoError
void remove_directory(const std::filesystem::path& path);
/// The same at once; what a network file system does not let go yet stays, for who removes the directory around it.
void remove_what_goes(const std::filesystem::path& path);

}  // namespace talus
