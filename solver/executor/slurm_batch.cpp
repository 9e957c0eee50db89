#include "executor/slurm_batch.hpp"

#include <algorithm>

#include "support/files.hpp"
#include "support/json.hpp"
#include "support/text.hpp"

namespace talus::executor {
namespace {

namespace fs = std::filesystem;

constexpr const char* script_text = "#!/bin/sh\nexec \"$@\"\n";
constexpr std::size_t max_bytes = std::size_t{256} << 20;
constexpr std::string_view status_ending = ".status";

Json to_json(const Run& run) {
  const Limits& limits = run.command.limits;
  return {{"name", run.name},
          {"group", run.group},
          {"arguments", run.command.arguments},
          {"environment", run.command.environment ? Json(*run.command.environment) : Json()},
          {"limits",
           {{"memory_bytes", limits.memory_bytes},
            {"cpu_seconds", limits.cpu_seconds},
            {"file_bytes", limits.file_bytes},
            {"wall_seconds", limits.wall_seconds},
            {"stall_seconds", limits.stall_seconds},
            {"core_dumps", limits.core_dumps}}},
          {"niceness", run.command.niceness},
          {"directory", run.directory.string()},
          {"log", run.log.string()}};
}

Run run_of(const Json& json) {
  Run run{.name = json.at("name"), .group = json.at("group"), .command = {}, .directory = {}, .log = {}};
  run.command.arguments = json.at("arguments").get<std::vector<std::string>>();
  if (!json.at("environment").is_null())
    run.command.environment = json.at("environment").get<std::vector<std::string>>();
  const Json& limits = json.at("limits");
  run.command.limits = {.memory_bytes = limits.at("memory_bytes"),
                        .cpu_seconds = limits.at("cpu_seconds"),
                        .file_bytes = limits.at("file_bytes"),
                        .wall_seconds = limits.at("wall_seconds"),
                        .stall_seconds = limits.value("stall_seconds", std::uint64_t{0}),  // older batches lack it
                        .core_dumps = limits.at("core_dumps")};
  run.command.niceness = json.at("niceness");
  run.directory = json.at("directory").get<std::string>();
  run.log = json.at("log").get<std::string>();
  if (run.command.arguments.empty()) throw IoError("a run without a program");
  return run;
}

/// "3-14.status"
std::optional<RunPlace> place_of(const std::string& name) {
  const std::size_t dash = name.find('-');
  if (dash == std::string::npos || !name.ends_with(status_ending)) return std::nullopt;
  const auto task = to_integer(name.substr(0, dash));
  const auto position = to_integer(name.substr(dash + 1, name.size() - dash - 1 - status_ending.size()));
  if (!task || !position) return std::nullopt;
  return RunPlace{static_cast<std::size_t>(*task), static_cast<std::size_t>(*position)};
}

}  // namespace

fs::path BatchDirectory::file(RunPlace run, std::string_view ending) const {
  return path_ / (std::to_string(run.task) + "-" + std::to_string(run.position) + std::string(ending));
}

void BatchDirectory::write(const std::vector<std::vector<Run>>& tasks) const {
  std::error_code error;
  fs::create_directories(path_, error);
  if (error) throw_io_error("create", path_, error.value());
  write_file_atomically(script(), script_text);
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    Json runs = Json::array();
    for (const Run& run : tasks[i]) runs.push_back(to_json(run));
    write_file_atomically(path_ / (std::to_string(i) + ".json"), Json{{"runs", std::move(runs)}}.dump() + "\n");
  }
}

std::optional<std::vector<Run>> BatchDirectory::runs(std::size_t task) const {
  const fs::path path = path_ / (std::to_string(task) + ".json");
  if (!fs::exists(path)) return std::nullopt;
  return read_json(path, max_bytes, "a list of runs", [](const Json& json) {
    std::vector<Run> all;
    for (const Json& run : json.at("runs")) all.push_back(run_of(run));
    return all;
  });
}

void BatchDirectory::write_status(RunPlace run, const RunStatus& status) const {
  const Json json = {{"exit_code", status.end.exit_code}, {"signal", status.end.signal},   {"seconds", status.seconds},
                     {"resumed", status.resumed},         {"timed_out", status.timed_out}, {"why", status.why}};
  write_file_atomically(file(run, status_ending), json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n");
}

bool BatchDirectory::has_status(RunPlace run) const { return fs::exists(file(run, status_ending)); }

RunStatus BatchDirectory::status(RunPlace run) const {
  const fs::path path = file(run, status_ending);
  return read_json(path, max_bytes, "the status of a run", [&](const Json& json) {
    RunStatus status{.end = {.exit_code = json.at("exit_code"), .signal = json.at("signal")},
                     .seconds = json.at("seconds"),
                     .resumed = json.at("resumed"),
                     .timed_out = json.at("timed_out"),
                     .why = json.at("why")};
    if (status.end.exit_code < 0 || status.end.exit_code > 255 || status.end.signal < 0 || status.end.signal > 64 ||
        !(status.seconds >= 0.0))
      throw IoError(path.string() + " holds what no run can say");
    return status;
  });
}

std::vector<RunPlace> BatchDirectory::statuses() const {
  std::vector<RunPlace> all;
  std::error_code error;
  for (fs::directory_iterator entry(path_, error), end; !error && entry != end; entry.increment(error))
    if (const auto place = place_of(entry->path().filename().string())) all.push_back(*place);
  if (error && error != std::errc::no_such_file_or_directory) throw_io_error("read", path_, error.value());
  std::sort(all.begin(), all.end());
  return all;
}

void BatchDirectory::want_killed(RunPlace run) const { write_file_atomically(file(run, ".kill"), "\n"); }
bool BatchDirectory::is_killed(RunPlace run) const { return fs::exists(file(run, ".kill")); }

void BatchDirectory::write_job(std::int64_t job) const { write_file_atomically(path_ / "job", std::to_string(job)); }

std::optional<std::int64_t> BatchDirectory::job() const {
  return to_integer(find_file(path_ / "job", max_bytes).value_or(""));
}

}  // namespace talus::executor
