// A stand-in for `talus run` in tests of the study: takes its arguments, sleeps, and ends as it is told.
//
//   fake_run DIARY MILLISECONDS SCRIPT CASE --realization I --seed S --threads T --out DIR --study-worker
//   [--perturbation E] [--resume]
//
// DIARY is a file that gets the lines "begin NAME fresh|resumed" and "end NAME". SCRIPT says what realizations do
// otherwise than end well: "3=diverge,5=kill-once". "8=after-40" waits until 40 runs have ended. With `orphan` in
// SCRIPT it outlives its parent.

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "io/result_json.hpp"
#include "studies.hpp"

namespace {

namespace fs = std::filesystem;

volatile sig_atomic_t asked_to_stop = 0;

std::map<std::string, std::string> options(const std::vector<std::string>& arguments) {
  std::map<std::string, std::string> all;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (!arguments[i].starts_with("--")) continue;
    const bool flag = i + 1 == arguments.size() || arguments[i + 1].starts_with("--");
    all[arguments[i]] = flag ? "yes" : arguments[i + 1];
  }
  return all;
}

std::map<std::string, std::string> script(const std::string& text) {
  std::map<std::string, std::string> all;
  std::istringstream in(text);
  for (std::string word; std::getline(in, word, ',');)
    all[word.substr(0, word.find('='))] = word.substr(word.find('=') + 1);
  return all;
}

void append(const fs::path& path, const std::string& line) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0666);
  if (file < 0 || ::write(file, line.data(), line.size()) != static_cast<ssize_t>(line.size())) ::_exit(99);
  ::close(file);
}

int count(const fs::path& diary, const std::string& word) {
  int n = 0;
  std::istringstream in(talus::fixtures::content(diary));
  for (std::string line; std::getline(in, line);) n += line.starts_with(word);
  return n;
}

talus::RunResult result(const std::string& name, double index) {
  const double zone = 34.0 + 2.0 * std::fmod(0.618033988749895 * index, 1.0);
  talus::RunResult r;
  r.measures = {zone, zone - 0.3, zone - 0.7, zone - 0.4, 0.5 * zone, zone - 0.6};
  r.steps = 1000;
  r.wall_clock = 1.5;
  char digest[17];
  std::snprintf(digest, sizeof digest, "%016zx", std::hash<std::string>{}(name));
  r.digest = digest;
  r.field = {.captured_variance = 0.25, .mean_phi = 0.4, .terms = 5};
  return r;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  const fs::path diary = words[0];
  auto behaviour = script(words[2]);
  const auto given = options(words);
  const std::string index = given.at("--realization");
  const bool replicate = given.contains("--perturbation");
  const std::string name = replicate ? "floor" + given.at("--perturbation") : index;
  const fs::path out = given.at("--out");
  const bool resumed = given.contains("--resume");
  if (!behaviour.contains("orphan") && given.contains("--study-worker")) ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::signal(SIGTERM, [](int) { asked_to_stop = 1; });

  const bool before = count(diary, "begin " + name + " ") > 0;
  append(diary, "begin " + name + (resumed ? " resumed\n" : " fresh\n"));
  fs::create_directories(out);
  const std::string what = behaviour[name];
  const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(std::stoi(words[1]));
  const int ends = what.starts_with("after-") ? std::stoi(what.substr(6)) : 0;
  while (!asked_to_stop && (std::chrono::steady_clock::now() < until || (ends > 0 && count(diary, "end ") < ends)))
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  if (asked_to_stop) {
    talus::fixtures::write(out / "checkpoint.h5", "state");
    return 6;
  }
  std::fprintf(stderr, "starting\n");
  if (what == "diverge") return std::fprintf(stderr, "diverged at step 12, particle 7\n"), 4;
  if (what == "internal") return 1;
  if (what == "bad-case") return std::fprintf(stderr, "/material: is bad\n"), 3;
  if (what == "full") return std::fprintf(stderr, "cannot write: No space left on device\n"), 5;
  if (what == "no-result") return 0;
  if (what == "kill" || (what == "kill-once" && !before)) ::raise(SIGKILL);
  if (what == "hang" || (what == "hang-once" && !before)) ::raise(SIGSTOP);
  if (asked_to_stop) return talus::fixtures::write(out / "checkpoint.h5", "state"), 6;
  if (what == "bad-checkpoint" && !before) return talus::fixtures::write(out / "checkpoint.h5", "damaged"), 6;
  if (what == "bad-checkpoint" && resumed) return 5;
  if (what == "stop-once" && !before) return talus::fixtures::write(out / "checkpoint.h5", "state"), 6;

  talus::Provenance provenance;
  provenance.version = "0.1.0";
  provenance.seed = std::stoull(given.at("--seed"));
  provenance.case_hash = "0123456789abcdef";
  provenance.realization = what == "wrong" ? 77 : std::stoll(index);
  if (replicate) provenance.perturbation = std::stod(given.at("--perturbation"));
  talus::Quality quality{.verdict = talus::Verdict::sound};
  if (what == "doubtful" || what == "invalid") {
    quality.verdict = *talus::verdict_of(what);
    quality.reasons = {{.check = "still_moving", .verdict = quality.verdict, .message = "it moves"}};
  }
  const double at = replicate ? 1e3 * std::stod(given.at("--perturbation")) : std::stod(index);
  talus::RunResult run = result(name, at);
  run.quality = quality;
  talus::fixtures::write(out / "snapshots.vtkhdf", "profile of " + name);
  talus::fixtures::write(out / "result.tmp", talus::with_checksum(talus::result_json(run, provenance)));
  fs::rename(out / "result.tmp", out / "result.json");
  append(diary, "end " + name + "\n");
  return 0;
}
