// Array jobs that an earlier process of ours submitted and that went on without it.

#include <algorithm>

#include "executor/slurm.hpp"
#include "support/files.hpp"

namespace talus::executor {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds patience{30};  ///< time in which a continuing study must adopt its runs

}  // namespace

void SlurmExecutor::recover() {
  std::error_code error;
  fs::create_directories(directory_, error);
  std::vector<fs::path> left;
  for (fs::directory_iterator entry(directory_, error), end; !error && entry != end; entry.increment(error))
    if (entry->is_directory()) left.push_back(entry->path());
  if (error) throw_io_error("read", directory_, error.value());
  std::sort(left.begin(), left.end());
  for (const fs::path& path : left) recover(path);
}

void SlurmExecutor::recover(const fs::path& path) {
  Batch& batch = batches_.emplace_back(Batch{.directory = BatchDirectory(path), .since = recovered_});
  batch.job = batch.directory.job();
  try {
    for (std::size_t i = 0;; ++i) {
      const std::optional<std::vector<Run>> runs = batch.directory.runs(i);
      if (!runs) break;
      Task& task = batch.tasks.emplace_back();
      for (const Run& run : *runs) task.entries.push_back({.run = run});
    }
  } catch (const IoError& e) {  // its tasks cannot read it either
    note_(e.what());
    batch.tasks.clear();
    return;
  }
  collect(batch);
  for (std::size_t i = 0; i < batch.tasks.size(); ++i)
    for (std::size_t p = 0; p < batch.tasks[i].entries.size(); ++p)
      if (const Entry& entry = batch.tasks[i].entries[p]; !entry.ended) unclaimed_[entry.run.name] = {&batch, {i, p}};
}

/// Whether the run is one that an earlier process of ours handed to Slurm; then it is that one.
bool SlurmExecutor::take_over(const Run& run, RunId id) {
  const auto at = unclaimed_.find(run.name);
  if (at == unclaimed_.end()) return false;
  const Place place = at->second;
  unclaimed_.erase(at);
  entry(place).id = id;
  open_[id] = place;
  return true;
}

/// Runs that no study has adopted by now are dropped.
void SlurmExecutor::drop_unclaimed() {
  if (unclaimed_.empty() || Steady::now() - recovered_ < patience || !has_room()) return;
  for (const auto& [name, place] : unclaimed_) {
    entry(place).killed = true;
    Task& task = place.batch->tasks[place.run.task];
    task.unwanted =
        std::none_of(task.entries.begin(), task.entries.end(), [](const Entry& e) { return e.id != 0 && !e.ended; });
  }
  unclaimed_.clear();
}

}  // namespace talus::executor
