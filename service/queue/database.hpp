#pragma once
// The SQLite file: one connection that writes, a few that read.

#include <SQLiteCpp/SQLiteCpp.h>

#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <vector>

namespace talus::service {

/// The database cannot be read or written.
struct StorageError : std::runtime_error {
  explicit StorageError(const std::string& text, bool full = false) : std::runtime_error(text), disk_full(full) {}
  bool disk_full;
};

/// Checks the structure of all pages (PRAGMA quick_check).
/// @throws StorageError naming the first faults, and what to do
void check_pages(SQLite::Database& db, const std::filesystem::path& path);

class Database {
 public:
  /// Opens or creates the file, checks its pages and brings its tables up to date.
  /// @throws StorageError also when it is damaged, or was written by a newer version
  explicit Database(std::filesystem::path path);

  /// Runs `action(SQLite::Database&)` in one BEGIN IMMEDIATE transaction; nothing of it remains if it throws.
  template <class Action>
  auto write(Action action) {
    const std::lock_guard lock(writing_);
    return translated([&] {
      SQLite::Transaction transaction(writer_, SQLite::TransactionBehavior::IMMEDIATE);
      if constexpr (std::is_void_v<decltype(action(writer_))>) {
        action(writer_);
        transaction.commit();
      } else {
        auto result = action(writer_);
        transaction.commit();
        return result;
      }
    });
  }

  /// Who waits for a connection that reads.
  enum class For { everyone, operation };

  /// Runs `action(SQLite::Database&)` on a connection that only reads.
  /// @param whom  one of the connections is kept for the operator: everyone else may use all of them up
  template <class Action>
  auto read(Action action, For whom = For::everyone) {
    const Reader reader(*this, whom);
    return translated([&] { return action(*reader.connection); });
  }

 private:
  struct Reader {
    Reader(Database& from, For whom);
    ~Reader();
    Database& owner;
    std::unique_ptr<SQLite::Database> connection;
  };

  template <class Action>
  static auto translated(Action action) {
    try {
      return action();
    } catch (const SQLite::Exception& e) {
      throw_storage_error(e);
    }
  }
  [[noreturn]] static void throw_storage_error(const SQLite::Exception& e);
  void migrate();

  std::filesystem::path path_;
  SQLite::Database writer_;
  std::mutex writing_;
  std::mutex pool_lock_;
  std::condition_variable returned_;
  std::vector<std::unique_ptr<SQLite::Database>> readers_;
};

}  // namespace talus::service
