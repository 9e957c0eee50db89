#include "queue/copy.hpp"

#include <SQLiteCpp/Backup.h>

#include "queue/database.hpp"
#include "queue/sql.hpp"

namespace talus::service {
namespace {

constexpr int patience_ms = 30'000;
constexpr int all_pages = -1;

/// Runs `action(SQLite::Database&)` on a queue. @throws StorageError naming the file
template <class Action>
auto with_queue(const std::filesystem::path& path, int flags, Action action) {
  try {
    SQLite::Database queue(path.string(), flags, patience_ms);
    return action(queue);
  } catch (const SQLite::Exception& e) {
    throw StorageError(path.string() + ": " + e.what());
  }
}

}  // namespace

void copy_queue(const std::filesystem::path& from, const std::filesystem::path& to) {
  with_queue(from, SQLite::OPEN_READWRITE, [&](SQLite::Database& source) {
    with_queue(to, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, [&](SQLite::Database& copy) {
      SQLite::Backup(copy, source).executeStep(all_pages);
      check_pages(copy, to);
    });
  });
}

std::set<std::string> studies_in(const std::filesystem::path& queue, bool dismissed) {
  return with_queue(queue, SQLite::OPEN_READWRITE, [&](SQLite::Database& db) {
    std::set<std::string> ids;
    SQLite::Statement query =
        statement(db, "SELECT id FROM jobs WHERE planned > 0 AND (state = 'dismissed') = ?", dismissed);
    while (query.executeStep()) ids.insert(query.getColumn(0).getString());
    return ids;
  });
}

void dismiss_jobs(const std::filesystem::path& queue, const std::set<std::string>& ids) {
  with_queue(queue, SQLite::OPEN_READWRITE, [&](SQLite::Database& db) {
    SQLite::Transaction transaction(db);
    for (const std::string& id : ids) {
      execute(db, "DELETE FROM runs WHERE job = (SELECT number FROM jobs WHERE id = ?)", id);
      execute(db, "UPDATE jobs SET state = 'dismissed', message = 'dismissed' WHERE id = ?", id);
    }
    transaction.commit();
  });
}

}  // namespace talus::service
