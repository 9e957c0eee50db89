#include "executor/slurm_config.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <functional>
#include <map>

#include "support/files.hpp"
#include "support/json.hpp"

namespace talus::executor {
namespace {

/// Options that Talus itself passes to sbatch.
constexpr std::array ours{
    "--array",   "-a",       "--chdir",  "-D",     "--cpus-per-task", "-c", "--error",  "-e", "--export", "--job-name",
    "-J",        "-o",       "--output", "-W",     "--open-mode",     "-n", "--ntasks", "-N", "--nodes",  "--parsable",
    "--requeue", "--signal", "--wait",   "--wrap", "--no-requeue"};

/// Reads a value; returns what is wrong with it, or an empty text.
using ValueReader = std::function<std::string(const Json&)>;

ValueReader text_into(std::string& into) {
  return [&into](const Json& value) -> std::string {
    if (!value.is_string()) return "is not a text";
    into = value.get<std::string>();
    const auto allowed = [](unsigned char c) {
      return (c < 128 && std::isalnum(c)) ||
             std::string_view("_-.,").find(static_cast<char>(c)) != std::string_view::npos;
    };
    return std::all_of(into.begin(), into.end(), allowed) ? "" : "may hold letters, digits and _-., only";
  };
}

template <class T>
ValueReader number_into(T& into, double least, double most) {
  return [=, &into](const Json& value) -> std::string {
    const bool right = std::is_integral_v<T> ? value.is_number_integer() : value.is_number();
    if (!right || value.get<double>() < least || value.get<double>() > most)
      return std::string("is not a") + (std::is_integral_v<T> ? "n integer" : " number") + " from " +
             Json(least).dump() + " to " + Json(most).dump();
    into = value.get<T>();
    return "";
  };
}

std::string option_into(std::vector<std::string>& into, const Json& value) {
  if (!value.is_string() || !value.get<std::string>().starts_with('-'))
    return "is not an option of sbatch such as \"--qos=low\"";
  const std::string& option = into.emplace_back(value);
  const std::string name = option.starts_with("--") ? option.substr(0, option.find('=')) : option.substr(0, 2);
  return std::find(ours.begin(), ours.end(), name) == ours.end() ? "" : name + " is set by Talus itself";
}

}  // namespace

SlurmConfig parse_slurm_config(const std::string& text, const std::string& place) {
  SlurmConfig config;
  std::string faults;
  const auto note = [&](const std::string& pointer, const std::string& fault) {
    if (!fault.empty()) faults += (faults.empty() ? "" : "\n") + place + ": /" + pointer + " " + fault;
  };
  const auto options_into = [&](const Json& list) -> std::string {
    if (!list.is_array()) return "is not a list";
    for (std::size_t i = 0; i < list.size(); ++i)
      note("sbatch_options/" + std::to_string(i), option_into(config.sbatch_options, list[i]));
    return "";
  };
  const std::map<std::string, ValueReader> keys{{"partition", text_into(config.partition)},
                                                {"account", text_into(config.account)},
                                                {"time_limit_min", number_into(config.time_limit_min, 1, 525600)},
                                                {"memory_MiB", number_into(config.memory_MiB, 1, 1 << 30)},
                                                {"cpus_per_task", number_into(config.cpus_per_task, 1, 4096)},
                                                {"sbatch_options", options_into},
                                                {"array_tasks", number_into(config.array_tasks, 1, 100000)},
                                                {"task_s", number_into(config.task_s, 1, 86400)},
                                                {"poll_s", number_into(config.poll_s, 0.05, 600)}};
  Json document;
  try {
    document = parse_json(text, place);
  } catch (const ConfigError& e) {
    throw SlurmConfigError(e.what());
  }
  if (!document.is_object()) throw SlurmConfigError(place + " is not a JSON object");
  for (const auto& [key, value] : document.items()) {
    const auto known = keys.find(key);
    note(key, known == keys.end() ? "is not a known key" : value.is_null() ? "is null" : known->second(value));
  }
  if (!faults.empty()) throw SlurmConfigError(faults);
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
