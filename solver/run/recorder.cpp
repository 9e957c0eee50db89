#include "run/recorder.hpp"

#include <chrono>

#include "io/history.hpp"

namespace talus {
namespace {

constexpr int history_rows = 500;  ///< of a run that goes on to its end time

}  // namespace

Recorder::Recorder(const std::filesystem::path& directory, const Simulation& simulation, const TimeControl& time,
                   bool resumed)
    : history_file_(directory / "history.csv"), due_(time.snapshots), history_interval_(time.end / history_rows) {
  const auto path = directory / "snapshots.vtkhdf";
  if (resumed) {
    snapshots_.emplace(SnapshotWriter::resume(path, simulation.time()));
    if (std::filesystem::exists(history_file_))
      for (const HistoryRow& row : read_history(history_file_))
        if (row.step <= simulation.steps()) history_.push_back(row);
  } else {
    writing_ =
        std::async(std::launch::async, [this, path, frame = simulation.frame()] { snapshots_.emplace(path, frame); });
  }
  if (history_.empty()) history_.push_back(simulation.history_row());
  while (!due_.empty() && due_.front() <= simulation.time()) due_.erase(due_.begin());
}

void Recorder::record(const Simulation& simulation) {
  if (writing_.valid() && writing_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) writing_.get();
  if (simulation.time() >= history_.back().time + history_interval_) history_.push_back(simulation.history_row());
  if (due_.empty() || simulation.time() < due_.front()) return;
  wait_for_snapshot();
  writing_ = std::async(std::launch::async, [this, frame = simulation.frame()] { snapshots_->append(frame); });
  while (!due_.empty() && due_.front() <= simulation.time()) due_.erase(due_.begin());
}

void Recorder::write_history() const { talus::write_history(history_file_, history_); }

void Recorder::finish(const Simulation& simulation) {
  if (history_.back().step < simulation.steps()) history_.push_back(simulation.history_row());
  write_history();
  wait_for_snapshot();
  snapshots_->append(simulation.frame());
  snapshots_->close();
}

}  // namespace talus
