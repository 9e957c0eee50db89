#pragma once
// What an array task of Slurm does on its machine.

#include "executor/slurm_batch.hpp"

namespace talus::executor {

/// Executes the runs of array task $SLURM_ARRAY_TASK_ID of a batch, one after the other; those that have a status were
/// executed before Slurm started the task again. A SIGTERM is passed on to the run, which leaves a checkpoint; then it
/// ends, and the runs without a status are for another task.
/// @return 0, also where there was nothing to do or it was asked to stop; 2 outside an array task
/// @throws BatchError, ProcessError
int execute_array_task(const BatchDirectory& batch);

}  // namespace talus::executor
