#include "run/recorder.hpp"

#include <algorithm>
#include <chrono>

#include "io/history.hpp"
#include "io/target_history.hpp"

namespace talus {
namespace {

constexpr int history_rows = 500;  ///< of a run that goes on to its end time

}  // namespace

Recorder::Recorder(const std::filesystem::path& directory, const Simulation& simulation, const Model& model,
                   const Provenance& provenance, bool resumed)
    : history_file_(directory / "history.csv"),
      target_file_(directory / "targets.csv"),
      due_(model.time.snapshots),
      exact_(model.time.snapshots_exact),
      end_(model.time.end),
      history_interval_(model.time.end / history_rows),
      targets_(model.targets) {
  const auto path = directory / "snapshots.vtkhdf";
  if (resumed) {
    snapshots_.emplace(SnapshotWriter::resume(path, simulation.time()));
    if (std::filesystem::exists(history_file_))
      for (const HistoryRow& row : read_history(history_file_))
        if (row.step <= simulation.steps()) history_.push_back(row);
    if (!targets_.empty() && std::filesystem::exists(target_file_))
      for (const TargetRow& row : read_target_history(target_file_, targets_))
        if (row.step <= simulation.steps()) target_history_.push_back(row);
  } else {
    writing_ = std::async(std::launch::async, [this, path, provenance, frame = simulation.frame()] {
      snapshots_.emplace(path, frame, provenance);
    });
  }
  if (history_.empty()) add_rows(simulation);
  while (!due_.empty() && due_.front() <= simulation.time()) due_.erase(due_.begin());
}

double Recorder::next_stop() const { return exact_ && !due_.empty() ? std::min(due_.front(), end_) : end_; }

void Recorder::record(const Simulation& simulation) {
  if (writing_.valid() && writing_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) writing_.get();
  if (simulation.time() >= history_.back().time + history_interval_) add_rows(simulation);
  if (due_.empty() || simulation.time() < due_.front()) return;
  wait_for_snapshot();
  writing_ = std::async(std::launch::async, [this, frame = simulation.frame()] { snapshots_->append(frame); });
  while (!due_.empty() && due_.front() <= simulation.time()) due_.erase(due_.begin());
}

void Recorder::add_rows(const Simulation& simulation) {
  history_.push_back(simulation.history_row());
  for (const TargetRow& row : simulation.target_rows()) target_history_.push_back(row);
}

void Recorder::write_history() const {
  talus::write_history(history_file_, history_);
  if (!targets_.empty()) write_target_history(target_file_, targets_, target_history_);
}

void Recorder::finish(const Simulation& simulation) {
  if (history_.back().step < simulation.steps()) add_rows(simulation);
  write_history();
  wait_for_snapshot();
  snapshots_->append(simulation.frame());
  snapshots_->close();
}

}  // namespace talus
