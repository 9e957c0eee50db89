#include "executor/slurm_queue.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <vector>

#include "support/error.hpp"
#include "support/text.hpp"

namespace talus::executor {
namespace {

using Json = nlohmann::json;

constexpr std::int64_t most_tasks = 4'000'000;  ///< of one array in Slurm

/// Final states of a job.
constexpr std::array over{"COMPLETED", "FAILED",   "CANCELLED",     "TIMEOUT",  "NODE_FAIL",
                          "PREEMPTED", "DEADLINE", "OUT_OF_MEMORY", "BOOT_FAIL"};
/// Flags beside a final state that say that the job has not ended yet.
constexpr std::array not_yet{"COMPLETING", "REQUEUED", "REQUEUE_HOLD", "REQUEUE_FED", "SPECIAL_EXIT"};

template <class Words>
bool is_in(const Words& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// A number as 22.05 writes it (7, null), or as later versions do ({"set": true, "number": 7}).
std::optional<std::int64_t> number(const Json& job, const char* key, const std::string& place) {
  Json value = job.value(key, Json());
  if (value.is_object()) value = value.value("set", false) ? value.value("number", Json("none")) : Json();
  if (value.is_null()) return std::nullopt;
  if (!value.is_number_integer() || value < 0) throw IoError(place + "/" + key + " is not a number of a job");
  return value.get<std::int64_t>();
}

/// 22.05 has one word, later versions a list.
QueuedTask state(const Json& job, const std::string& place) {
  std::vector<std::string> words;
  const Json given = job.value("job_state", Json());
  for (const Json& word : given.is_array() ? given : Json::array({given}))
    if (word.is_string()) words.push_back(word);
  if (words.empty()) throw IoError(place + "/job_state is not a state");
  const auto has = [&](const auto& list) {
    return std::any_of(words.begin(), words.end(), [&](const std::string& word) { return is_in(list, word); });
  };
  return {.state = words.front(), .alive = !has(over) || has(not_yet), .running = is_in(words, std::string("RUNNING"))};
}

std::string text(const Json& job, const char* key) {
  const Json value = job.value(key, Json());
  return value.is_string() ? value.get<std::string>() : std::string{};
}

/// "5" or "7-11" or "7-11:2"
bool add_range(const std::string& part, std::set<std::int64_t>& all) {
  const std::size_t dash = part.find('-'), colon = part.find(':');
  const auto first = to_integer(part.substr(0, dash));
  const auto last = dash == std::string::npos ? first : to_integer(part.substr(dash + 1, colon - dash - 1));
  const auto step = colon == std::string::npos ? std::optional<std::int64_t>(1) : to_integer(part.substr(colon + 1));
  if (!first || !last || !step || *step < 1 || *last < *first || *last > most_tasks) return false;
  for (std::int64_t i = *first; i <= *last; i += *step) all.insert(i);
  return true;
}

}  // namespace

SlurmQueue::SlurmQueue(const std::string& json) {
  const Json document = Json::parse(json, nullptr, false);
  if (!document.is_object()) throw IoError("squeue: the answer is not a JSON object");
  const auto jobs = document.find("jobs");
  if (jobs == document.end() || !jobs->is_array()) throw IoError("squeue: /jobs is not a list");
  if (const auto errors = document.find("errors"); errors != document.end() && errors->is_array() && !errors->empty())
    throw IoError("squeue: " + errors->front().dump());
  for (std::size_t i = 0; i < jobs->size(); ++i) {
    const Json& job = (*jobs)[i];
    const std::string place = "squeue: /jobs/" + std::to_string(i);
    if (!job.is_object()) throw IoError(place + " is not an object");
    const auto array = number(job, "array_job_id", place);
    if (!array || *array == 0) continue;  // not an array, so not from Talus
    QueuedTask task = state(job, place);
    if (const std::string reason = text(job, "state_reason"); reason != "None") task.reason = reason;
    names_[text(job, "name")] = *array;
    if (const auto index = number(job, "array_task_id", place))
      tasks_[{*array, *index}] = task;
    else
      waiting_[*array] = {task, parse_indices(text(job, "array_task_string"))};
  }
}

std::optional<QueuedTask> SlurmQueue::task(std::int64_t array_job, std::int64_t index) const {
  if (const auto at = tasks_.find({array_job, index}); at != tasks_.end()) return at->second;
  const auto at = waiting_.find(array_job);
  if (at == waiting_.end() || (at->second.indices && !at->second.indices->contains(index))) return std::nullopt;
  return at->second.task;
}

std::optional<std::int64_t> SlurmQueue::job_named(const std::string& name) const {
  const auto at = names_.find(name);
  return at == names_.end() ? std::nullopt : std::optional(at->second);
}

std::int64_t parse_job_id(const std::string& answer) {
  const auto id = to_integer(answer.substr(0, answer.find_first_of(";\n")));
  if (!id || *id == 0) throw IoError("sbatch: \"" + answer.substr(0, 200) + "\" is not the number of a job");
  return *id;
}

std::optional<std::set<std::int64_t>> parse_indices(const std::string& text) {
  std::set<std::int64_t> all;
  const std::string list = text.substr(0, text.find('%'));
  for (std::size_t start = 0; start <= list.size();) {
    const std::size_t end = std::min(list.find(',', start), list.size());
    if (!add_range(list.substr(start, end - start), all)) return std::nullopt;
    start = end + 1;
  }
  return all;
}

}  // namespace talus::executor
