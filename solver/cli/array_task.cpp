// talus array-task: what `--executor slurm` lets Slurm start on its machines.

#include "executor/array_task.hpp"

#include <filesystem>
#include <memory>

#include "cli/verbs.hpp"
#include "support/error.hpp"

namespace talus::cli {

void add_array_task(CLI::App& app, Action& action) {
  auto batch = std::make_shared<std::filesystem::path>();
  CLI::App* verb = app.add_subcommand("array-task", "execute the runs of one task of an array job")->group("");
  verb->add_option("batch", *batch, "directory of the batch")->required();
  verb->callback([batch, &action] {
    action = [batch] {
      try {
        return static_cast<Exit>(executor::execute_array_task(executor::BatchDirectory(*batch)));
      } catch (const executor::BatchError& e) {
        throw IoError(e.what());
      } catch (const executor::ProcessError& e) {
        throw IoError(e.what());
      }
    };
  });
}

}  // namespace talus::cli
