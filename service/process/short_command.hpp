#pragma once
// Runs a short command to its end and takes what it said.

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>

#include "executor/process.hpp"

namespace talus::service {

/// What a short command said.
struct CommandOutput {
  executor::ProcessEnd end;
  bool timed_out = false;
  std::string out;
  std::string err;
};

/// Runs a command to its end, its output through files in `scratch`. It is killed after `limit`, or when `give_up` says
/// so.
/// @throws IoError
CommandOutput run_to_end(const executor::Command& command, const std::filesystem::path& scratch,
                         std::chrono::milliseconds limit, const std::function<bool()>& give_up = {});

}  // namespace talus::service
