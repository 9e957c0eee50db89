// What a study of many realizations costs its front end: bench_study_store DIR N make|open|resume|stats.
//
//   make    the directory of a study with N results in runs/, as runs leave them
//   open    DirectoryStore and Estimator over them
//   resume  run_study(): opens it, finds nothing to run, writes tables and study.json
//   stats   the tables read again and summarised, as `talus stats` does
//
// Prints the wall clock of the step; GNU time -v adds the user time and the peak of memory.

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "io/result_json.hpp"
#include "study/directory_store.hpp"
#include "study/publish.hpp"
#include "study/run_study.hpp"
#include "support/output_directory.hpp"

namespace {

using namespace talus;
namespace fs = std::filesystem;

Plan plan(std::int64_t realizations) {
  Plan p{.title = "A slope", .of = {"0123456789abcdef"}, .version = "0.1.0", .seed = 42, .study = {}};
  p.study.realizations = realizations;
  p.study.noise_floor_replicates = 0;
  return p;
}

std::string result(std::int64_t index) {
  const double zone = 34.0 + 2.0 * std::fmod(0.618033988749895 * static_cast<double>(index), 1.0);
  RunResult r;
  r.measures = {zone, zone - 0.3, zone - 0.7, zone - 0.4, 0.5 * zone};
  r.digest = "0123456789abcdef";
  Provenance from;
  from.version = "0.1.0";
  from.seed = 42;
  from.realization = index;
  from.case_hash = "0123456789abcdef";
  return result_json(r, from).dump(2);
}

void make(const fs::path& directory, std::int64_t n) {
  OutputDirectory(directory, OutputKind::study, {"0123456789abcdef"}, true);
  fs::create_directories(directory / "runs");
  write_plan(directory, plan(n));
  for (std::int64_t i = 0; i < n; ++i) std::ofstream(StudyPaths{directory}.result(realization(i))) << result(i) << "\n";
}

void open(const fs::path& directory, std::int64_t n) {
  DirectoryStore store({directory}, plan(n), 0, n);
  Estimator estimator(plan(n).study, 0, n);
  store.visit_records(0, [&](const RunKey& key, std::optional<double> zone) { estimator.add(key, zone); });
  std::printf("%lld done, mean %.6f m\n", static_cast<long long>(estimator.done()), estimator.mean().value_or(0.0));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: bench_study_store DIR N make|open|resume|stats\n");
    return 2;
  }
  const fs::path directory = argv[1];
  const std::int64_t n = std::atoll(argv[2]);
  const std::string step = argv[3];
  const auto begin = std::chrono::steady_clock::now();
  if (step == "make") make(directory, n);
  if (step == "open") open(directory, n);
  if (step == "resume") {
    RunStudyOptions options;
    options.program = {"/bin/false"};
    run_study(plan(n), {{"title", "A slope"}}, directory, options);
  }
  if (step == "stats") {
    const Tables tables = read_tables(directory);
    std::printf("%lld bytes\n",
                static_cast<long long>(summary_of(tables.plan, tables.runs, tables.floor).json().dump(2).size()));
  }
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  std::printf("%s of %lld: %.2f s\n", step.c_str(), static_cast<long long>(n), taken.count());
}
