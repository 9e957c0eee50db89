// A study in a process of its own: study_process DIR REALIZATIONS WORKERS PROGRAM...

#include <cstdlib>

#include "studies.hpp"
#include "study/run_study.hpp"

int main(int argc, char** argv) {
  talus::RunStudyOptions options;
  options.workers = std::atoi(argv[3]);
  options.program.assign(argv + 4, argv + argc);
  options.poll = std::chrono::milliseconds(2);
  talus::Plan plan = talus::fixtures::plan(std::atoi(argv[2]));
  plan.study.noise_floor_replicates = 2;
  return static_cast<int>(talus::run_study(plan, {{"title", "A slope"}}, argv[1], options));
}
