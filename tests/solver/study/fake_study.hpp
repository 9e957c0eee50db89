#pragma once
// A study of fake_run, a stand-in for `talus run` that keeps a diary of what was asked of it.

#include <chrono>
#include <cstdint>
#include <map>
#include <sstream>
#include <thread>

#include "studies.hpp"
#include "study/publish.hpp"
#include "study/run_study.hpp"

namespace talus::fixtures {

/// A study in a directory of its own; run() may be called again and again, as a person repeats a command.
struct Study {
  TemporaryDirectory directory;
  std::filesystem::path out = directory / "study";
  std::filesystem::path diary = directory / "diary";
  Plan plan;
  RunStudyOptions options;
  std::string script;
  int milliseconds = 5;
  std::vector<std::string> notes;

  explicit Study(std::int64_t realizations, std::string script_ = "ok")
      : plan(fixtures::plan(realizations)), script(std::move(script_)) {
    options.workers = 3;
    options.threads = 2;
    options.poll = std::chrono::milliseconds(1);
    options.note = [this](const std::string& text) { notes.push_back(text); };
    plan.study.max_failed_share = 1.0;
    options.attempts = 2;
  }
  std::vector<std::string> program() const { return {FAKE_RUN, diary.string(), std::to_string(milliseconds), script}; }
  StudyEnd run() {
    options.program = program();
    return run_study(plan, {{"title", "A slope"}, {"study", {{"realizations", plan.study.realizations}}}}, out,
                     options);
  }
  /// How often the diary has a line that starts so.
  int count(const std::string& start) const {
    int n = 0;
    std::istringstream in(content(diary));
    for (std::string line; std::getline(in, line);) n += line.starts_with(start);
    return n;
  }
  /// How often the diary says that the same run ended.
  int most_ends() const {
    std::map<std::string, int> ends;
    std::istringstream in(content(diary));
    int most = 0;
    for (std::string line; std::getline(in, line);)
      if (line.starts_with("end ")) most = std::max(most, ++ends[line]);
    return most;
  }
  std::vector<Record> records() const { return read_csv(out / "realizations.csv", "index"); }
  nlohmann::json summary() const { return nlohmann::json::parse(content(out / "study.json")); }
  std::string text_of_notes() const {
    std::string all;
    for (const std::string& n : notes) all += n + "\n";
    return all;
  }
};

/// Runs `action` until it is true.
template <class Condition>
void wait_until(Condition condition) {
  while (!condition()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

}  // namespace talus::fixtures
