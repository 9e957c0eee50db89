#pragma once

namespace talus::cli {

/// From now on SIGINT and SIGTERM only raise a flag, so that the run can checkpoint; a second one ends the process at
/// once if `twice_ends`. A worker may get the same request twice, from its parent and from its scheduler.
void catch_stop_signals(bool twice_ends = true);
/// Has one arrived?
bool stop_requested();
/// Asks the kernel to kill this process when its parent dies, so that no worker outlives its study.
/// Returns false if the parent is already gone.
bool die_with_parent();

}  // namespace talus::cli
