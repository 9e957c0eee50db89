#include "executor/slurm_batch.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <system_error>

namespace talus::executor {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* script_text = "#!/bin/sh\nexec \"$@\"\n";
constexpr std::uintmax_t max_bytes = std::uintmax_t{256} << 20;

/// By a temporary file of this process beside it, fsync, rename.
void write_whole(const fs::path& path, const std::string& text) {
  const fs::path temporary = path.string() + ".tmp-" + std::to_string(::getpid());
  const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) fail("create", temporary, errno);
  int error = 0;
  for (std::size_t at = 0; at < text.size() && error == 0;) {
    const ssize_t n = ::write(file, text.data() + at, text.size() - at);
    if (n > 0) at += static_cast<std::size_t>(n);
    if (n < 0 && errno != EINTR) error = errno;
  }
  if (error == 0 && ::fsync(file) != 0) error = errno;
  if (::close(file) != 0 && error == 0) error = errno;
  if (error == 0 && ::rename(temporary.c_str(), path.c_str()) != 0) error = errno;
  if (error == 0) return;
  ::unlink(temporary.c_str());
  fail("write", path, error);
}

/// Nothing where there is no such file.
std::optional<Json> read_json(const fs::path& path) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);
  if (error == std::errc::no_such_file_or_directory) return std::nullopt;
  if (error || size > max_bytes) throw BatchError(path.string() + " cannot be read, or is too large");
  std::ifstream file(path, std::ios::binary);
  Json json = Json::parse(std::string(std::istreambuf_iterator<char>(file), {}), nullptr, false);
  if (json.is_discarded()) throw BatchError(path.string() + " is not JSON");
  return json;
}

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
                        .core_dumps = limits.at("core_dumps")};
  run.command.niceness = json.at("niceness");
  run.directory = json.at("directory").get<std::string>();
  run.log = json.at("log").get<std::string>();
  if (run.command.arguments.empty()) throw BatchError("a run without a program");
  return run;
}

std::optional<std::int64_t> integer(const std::string& digits) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size() || value < 0) return std::nullopt;
  return value;
}

/// "3-14.status"
std::optional<RunPlace> place_of(const std::string& name) {
  constexpr const char* ending = ".status";
  if (!name.ends_with(ending)) return std::nullopt;
  const std::size_t dash = name.find('-');
  if (dash == std::string::npos) return std::nullopt;
  const auto task = integer(name.substr(0, dash));
  const auto position = integer(name.substr(dash + 1, name.size() - dash - 1 - std::char_traits<char>::length(ending)));
  if (!task || !position) return std::nullopt;
  return RunPlace{static_cast<std::size_t>(*task), static_cast<std::size_t>(*position)};
}

}  // namespace

fs::path BatchDirectory::file(RunPlace run, const char* ending) const {
  return path_ / (std::to_string(run.task) + "-" + std::to_string(run.position) + ending);
}

void BatchDirectory::write(const std::vector<std::vector<Run>>& tasks) const {
  std::error_code error;
  fs::create_directories(path_, error);
  if (error) fail("create", path_, error.value());
  write_whole(script(), script_text);
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    Json runs = Json::array();
    for (const Run& run : tasks[i]) runs.push_back(to_json(run));
    write_whole(path_ / (std::to_string(i) + ".json"), Json{{"runs", std::move(runs)}}.dump() + "\n");
  }
}

std::optional<std::vector<Run>> BatchDirectory::runs(std::size_t task) const {
  const fs::path path = path_ / (std::to_string(task) + ".json");
  const std::optional<Json> json = read_json(path);
  if (!json) return std::nullopt;
  try {
    std::vector<Run> all;
    for (const Json& run : json->at("runs")) all.push_back(run_of(run));
    return all;
  } catch (const Json::exception& e) {
    throw BatchError(path.string() + ": " + e.what());
  }
}

void BatchDirectory::write_status(RunPlace run, const RunStatus& status) const {
  const Json json = {{"exit_code", status.end.exit_code}, {"signal", status.end.signal},   {"seconds", status.seconds},
                     {"resumed", status.resumed},         {"timed_out", status.timed_out}, {"why", status.why}};
  write_whole(file(run, ".status"), json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n");
}

bool BatchDirectory::has_status(RunPlace run) const { return fs::exists(file(run, ".status")); }

RunStatus BatchDirectory::status(RunPlace run) const {
  const fs::path path = file(run, ".status");
  const std::optional<Json> json = read_json(path);
  if (!json) throw BatchError(path.string() + " is gone");
  try {
    RunStatus status{.end = {.exit_code = json->at("exit_code"), .signal = json->at("signal")},
                     .seconds = json->at("seconds"),
                     .resumed = json->at("resumed"),
                     .timed_out = json->at("timed_out"),
                     .why = json->at("why")};
    if (status.end.exit_code < 0 || status.end.exit_code > 255 || status.end.signal < 0 || status.end.signal > 64 ||
        !(status.seconds >= 0.0))
      throw BatchError(path.string() + " holds what no run can say");
    return status;
  } catch (const Json::exception& e) {
    throw BatchError(path.string() + ": " + e.what());
  }
}

std::vector<RunPlace> BatchDirectory::statuses() const {
  std::vector<RunPlace> all;
  std::error_code error;
  for (fs::directory_iterator entry(path_, error), end; !error && entry != end; entry.increment(error))
    if (const auto place = place_of(entry->path().filename().string())) all.push_back(*place);
  if (error && error != std::errc::no_such_file_or_directory) fail("read", path_, error.value());
  std::sort(all.begin(), all.end());
  return all;
}

void BatchDirectory::want_killed(RunPlace run) const { write_whole(file(run, ".kill"), "\n"); }
bool BatchDirectory::is_killed(RunPlace run) const { return fs::exists(file(run, ".kill")); }

void BatchDirectory::write_job(std::int64_t job) const { write_whole(path_ / "job", std::to_string(job)); }

std::optional<std::int64_t> BatchDirectory::job() const {
  std::ifstream file(path_ / "job");
  std::string text;
  std::getline(file, text);
  return integer(text);
}

}  // namespace talus::executor
