#include "process/short_command.hpp"

#include <signal.h>

#include <thread>

#include "base/digest.hpp"
#include "support/files.hpp"

namespace talus::service {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_out_bytes = std::size_t{64} << 20;

}  // namespace

TemporaryDirectory::TemporaryDirectory(fs::path path) : path_(std::move(path)) {
  std::error_code error;
  fs::create_directories(path_, error);
  if (error) throw_io_error("create", path_, error.value());
}

TemporaryDirectory::~TemporaryDirectory() {
  std::error_code ignored;
  if (!kept_) fs::remove_all(path_, ignored);
}

void TemporaryDirectory::move_to(const fs::path& place) {
  rename_durably(path_, place);
  path_ = place;
}

CommandOutput run_to_end(const executor::Command& command, const fs::path& scratch, std::chrono::milliseconds limit,
                         const std::function<bool()>& give_up) {
  const TemporaryDirectory files(scratch / (std::string(command_prefix) + random_hex(8)));
  CommandOutput output;
  executor::Process child(command, files / "out", files / "err");
  const auto deadline = std::chrono::steady_clock::now() + limit;
  std::chrono::milliseconds nap{1};
  for (std::optional<executor::ProcessEnd> end; !(end = child.poll()); std::this_thread::sleep_for(nap)) {
    if (!output.timed_out && (std::chrono::steady_clock::now() > deadline || (give_up && give_up()))) {
      output.timed_out = true;
      child.signal(SIGKILL);
    }
    nap = std::min(nap * 2, std::chrono::milliseconds(20));
  }
  output.end = *child.poll();
  output.out = find_file(files / "out", max_out_bytes).value_or("");
  output.err = executor::tail(files / "err", 4000);
  return output;
}

}  // namespace talus::service
