#include "executor/slurm_config.hpp"

#include <algorithm>
#include <array>

#include "support/files.hpp"
#include "support/json.hpp"

namespace talus::executor {
namespace {

/// What we say to sbatch ourselves.
constexpr std::array ours{
    "--array",   "-a",       "--chdir",  "-D",     "--cpus-per-task", "-c", "--error",  "-e", "--export", "--job-name",
    "-J",        "-o",       "--output", "-W",     "--open-mode",     "-n", "--ntasks", "-N", "--nodes",  "--parsable",
    "--requeue", "--signal", "--wait",   "--wrap", "--no-requeue"};

/// The members of one object, each read once; a member left over is a fault.
class Reader {
 public:
  Reader(Json document, std::string place) : document_(std::move(document)), place_(std::move(place)) {
    if (document_.is_object()) return;
    fault("", "is not a JSON object");
    document_ = Json::object();
  }
  void text(const char* key, std::string& into) {
    const Json value = take(key);
    if (value.is_null()) return;
    if (!value.is_string()) return fault(key, "is not a text");
    into = value.get<std::string>();
    if (into.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.,") !=
        std::string::npos)
      fault(key, "may hold letters, digits and _-., only");
  }
  template <class T>
  void number(const char* key, T& into, double least, double most) {
    const Json value = take(key);
    if (value.is_null()) return;
    const bool right = std::is_integral_v<T> ? value.is_number_integer() : value.is_number();
    if (!right || value.get<double>() < least || value.get<double>() > most)
      return fault(key, std::string("is not a") + (std::is_integral_v<T> ? "n integer" : " number") + " from " +
                            Json(least).dump() + " to " + Json(most).dump());
    into = value.get<T>();
  }
  void options(const char* key, std::vector<std::string>& into) {
    const Json value = take(key);
    if (value.is_null()) return;
    if (!value.is_array()) return fault(key, "is not a list");
    for (std::size_t i = 0; i < value.size(); ++i) {
      const std::string at = std::string(key) + "/" + std::to_string(i);
      if (!value[i].is_string() || !value[i].get<std::string>().starts_with('-')) {
        fault(at, "is not an option of sbatch such as \"--qos=low\"");
        continue;
      }
      into.push_back(value[i]);
      const std::string& option = into.back();
      const std::string name = option.starts_with("--") ? option.substr(0, option.find('=')) : option.substr(0, 2);
      if (std::find(ours.begin(), ours.end(), name) != ours.end()) fault(at, name + " is set by Talus itself");
    }
  }
  void finish() {
    for (const auto& [key, value] : document_.items()) fault(key, "is not a known key");
    if (!faults_.empty()) throw SlurmConfigError(faults_);
  }

 private:
  Json take(const char* key) {
    const auto at = document_.find(key);
    if (at == document_.end()) return {};
    Json value = *at;
    document_.erase(at);
    if (value.is_null()) fault(key, "is null");
    return value;
  }
  void fault(const std::string& pointer, const std::string& message) {
    faults_ += (faults_.empty() ? "" : "\n") + place_ + (pointer.empty() ? "" : ": /" + pointer) + " " + message;
  }

  Json document_;
  std::string place_, faults_;
};

}  // namespace

SlurmConfig parse_slurm_config(const std::string& text, const std::string& place) {
  Json document;
  try {
    document = parse_json(text, place);
  } catch (const ConfigError& e) {
    throw SlurmConfigError(e.what());
  }
  SlurmConfig config;
  Reader reader(document, place);
  reader.text("partition", config.partition);
  reader.text("account", config.account);
  reader.number("time_limit_min", config.time_limit_min, 1, 525600);
  reader.number("memory_MiB", config.memory_MiB, 1, 1 << 30);
  reader.number("cpus_per_task", config.cpus_per_task, 1, 4096);
  reader.options("sbatch_options", config.sbatch_options);
  reader.number("array_tasks", config.array_tasks, 1, 100000);
  reader.number("task_s", config.task_s, 1, 86400);
  reader.number("poll_s", config.poll_s, 0.05, 600);
  reader.finish();
  return config;
}

SlurmConfig read_slurm_config(const std::filesystem::path& file) {
  try {
    return parse_slurm_config(read_file(file, JsonLimits{}.bytes), file.string());
  } catch (const IoError& e) {
    throw SlurmConfigError(e.what());
  }
}

}  // namespace talus::executor
