#include "queue/database.hpp"

#include <sqlite3.h>

#include <set>
#include <string>

#include "base/documents.hpp"
#include "base/json.hpp"
#include "study/record.hpp"
#include "support/measures.hpp"

namespace talus::service {
namespace {

constexpr int busy_timeout_ms = 5000;
constexpr int reader_count = 8;
constexpr int journal_bytes = 16 << 20;  ///< of the write-ahead log, once it has been copied into the database
constexpr const char* damage_advice =
    "restore a backup, or move it away with its -wal and -shm and take the jobs back with talusd --adopt";

/// FULL: what is committed is on the disk, so a 201 holds after a power cut. INCREMENTAL takes effect on a new file.
void prepare(SQLite::Database& db) {
  db.exec("PRAGMA auto_vacuum = INCREMENTAL");
  db.exec("PRAGMA journal_mode = WAL");
  db.exec("PRAGMA journal_size_limit = " + std::to_string(journal_bytes));
  db.exec("PRAGMA synchronous = FULL");
  db.exec("PRAGMA foreign_keys = ON");
}

/// Adds a column for each number of a run that the database does not have yet; it is NULL in the runs recorded before.
void add_number_columns(SQLite::Database& db) {
  std::set<std::string> columns;
  for (SQLite::Statement query(db, "SELECT name FROM pragma_table_info('runs')"); query.executeStep();)
    columns.insert(query.getColumn(0).getString());
  const Record any;
  visit_numbers(any, [&](const char* key, const char*, auto) {
    if (columns.contains(key)) return;
    db.exec("DROP INDEX IF EXISTS runs_measures");
    db.exec(std::string("ALTER TABLE runs ADD COLUMN ") + key + " REAL");
  });
  std::string all;
  for (const Measure& measure : measure_table) all += std::string(", ") + measure.key;
  // For histograms: the measures of the runs that are done, in order. With the state among its columns the index covers
  // the query, so no row of the table is read.
  db.exec("CREATE INDEX IF NOT EXISTS runs_measures ON runs (job, level, kind, idx, state" + all +
          ") WHERE state = 'done'");
}

/// Rewrites a database of an earlier version, so that unused pages can be returned to the file system. Without room for
/// that it stays as it is.
void allow_shrinking(SQLite::Database& db, const std::filesystem::path& path) {
  constexpr int incremental = 2;
  if (db.execAndGet("PRAGMA auto_vacuum").getInt() == incremental) return;
  try {
    db.exec("PRAGMA auto_vacuum = INCREMENTAL");
    db.exec("VACUUM");
  } catch (const SQLite::Exception& e) {
    log_info("not_rewritten", {{"file", path.string()}, {"why", e.what()}});
  }
}

SQLite::Database open(const std::filesystem::path& path) try {
  return {path.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, busy_timeout_ms};
} catch (const SQLite::Exception& e) {
  throw StorageError("cannot open " + path.string() + ": " + e.what());
}

}  // namespace

void check_pages(SQLite::Database& db, const std::filesystem::path& path) {
  std::string faults;
  SQLite::Statement query(db, "PRAGMA quick_check(3)");
  while (query.executeStep()) {
    const std::string line = query.getColumn(0).getString();
    if (line != "ok") faults += "; " + line;
  }
  if (!faults.empty())
    throw StorageError(
        path.string() + " is damaged" + faults +
        "; restore a backup, or move it away with its -wal and -shm and take the jobs back with --adopt");
}

Database::Database(std::filesystem::path path) : path_(std::move(path)), writer_(open(path_)) {
  translated([&] {
    prepare(writer_);
    check_pages(writer_, path_);
  });
  migrate();
  translated([&] {
    allow_shrinking(writer_, path_);
    // The histograms come from this index alone. Unlike the pages of tables, its content follows from other pages.
    if (writer_.execAndGet("PRAGMA integrity_check(1)").getString() != "ok") writer_.exec("REINDEX");
    for (int i = 0; i < reader_count; ++i) {
      readers_.push_back(std::make_unique<SQLite::Database>(path_.string(), SQLite::OPEN_READWRITE, busy_timeout_ms));
      readers_.back()->exec("PRAGMA query_only = ON");
    }
  });
}

void Database::migrate() {
  const int known = static_cast<int>(migrations().size());
  write([&](SQLite::Database& db) {
    const int found = db.execAndGet("PRAGMA user_version").getInt();
    if (found > known)
      throw StorageError(path_.string() + " is of version " + std::to_string(found) + ", which is newer than " +
                         std::to_string(known) + "; use the newer talusd");
    for (auto step = migrations().begin() + found; step != migrations().end(); ++step) db.exec(step->second);
    add_number_columns(db);
    if (found < known) db.exec("PRAGMA user_version = " + std::to_string(known));
  });
}

Database::Reader::Reader(Database& from, For whom) : owner(from) {
  const std::size_t kept = whom == For::operation ? 0 : 1;
  std::unique_lock lock(owner.pool_lock_);
  owner.returned_.wait(lock, [&] { return owner.readers_.size() > kept; });
  connection = std::move(owner.readers_.back());
  owner.readers_.pop_back();
}

Database::Reader::~Reader() {
  {
    const std::lock_guard lock(owner.pool_lock_);
    owner.readers_.push_back(std::move(connection));
  }
  owner.returned_.notify_all();  // the first to wait may not be the one that may have it
}

void Database::throw_storage_error(const SQLite::Exception& e) {
  switch (e.getErrorCode()) {
    case SQLITE_FULL:
      throw StorageError("the disk is full: nothing can be recorded until there is room", true);
    case SQLITE_READONLY:
    case SQLITE_CANTOPEN:
    case SQLITE_PERM:
      throw StorageError(std::string("the queue cannot be written: ") + e.what());
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      throw StorageError("the queue is busy; try again");
    case SQLITE_IOERR:  // also when there is no room for the write-ahead log
      throw StorageError(std::string("the queue cannot be written, probably because the disk is full: ") + e.what(),
                         true);
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      throw StorageError(std::string("the queue is damaged: ") + e.what() + "; " + damage_advice);
    default:
      throw StorageError(std::string("the queue: ") + e.what());
  }
}

}  // namespace talus::service
