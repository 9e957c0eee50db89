#pragma once
// The files that a run writes while it goes on: snapshots, history, and that of its targets.

#include <filesystem>
#include <future>
#include <optional>
#include <vector>

#include "io/vtkhdf.hpp"
#include "simulation/simulation.hpp"

namespace talus {

/// Writes snapshots.vtkhdf, history.csv and, where the case has targets, targets.csv into a directory. Snapshots are
/// written by a thread of their own while the run goes on. Not thread-safe: one run owns it.
class Recorder {
 public:
  /// @param provenance  is written into the snapshots
  /// @param resumed     go on with the files of an earlier process, as they were at the time of the simulation
  /// @throws IoError when those cannot be read
  Recorder(const std::filesystem::path& directory, const Simulation& simulation, const Model& model,
           const Provenance& provenance, bool resumed);

  /// The time that the next step must not pass [s]: the end, or with TimeControl::snapshots_exact the next snapshot.
  double next_stop() const;
  /// To be called after every step. A snapshot is that of the first step at or after its time.
  /// @throws IoError when a snapshot could not be written
  void record(const Simulation& simulation);
  /// Waits until the last snapshot is in its file. To be called before anything else that uses HDF5.
  /// @throws IoError when it could not be written
  void wait_for_snapshot() {
    if (writing_.valid()) writing_.get();
  }
  /// @throws IoError
  void write_history() const;
  /// The end of the run: last row, last snapshot.
  /// @throws IoError
  void finish(const Simulation& simulation);

 private:
  void add_rows(const Simulation& simulation);

  std::filesystem::path history_file_, target_file_;
  std::optional<SnapshotWriter> snapshots_;
  std::vector<double> due_;  ///< snapshot times to come [s]
  bool exact_;               ///< steps end at the times of snapshots
  double end_;               ///< of the run [s]
  double history_interval_;  ///< [s]
  std::vector<HistoryRow> history_;
  std::vector<Target> targets_;
  std::vector<TargetRow> target_history_;
  std::future<void> writing_;  ///< last member: its thread is waited for before the others are destroyed
};

}  // namespace talus
