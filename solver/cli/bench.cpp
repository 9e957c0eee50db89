// talus bench: how fast the solver is here, by size, threads, integrator, yield law and precision. Figures only, no
// verdict.

#include <omp.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <thread>

#include "case/load.hpp"
#include "cli/help.hpp"
#include "cli/schemas.hpp"
#include "cli/verbs.hpp"
#include "simulation/simulation.hpp"
#include "support/json.hpp"

namespace talus::cli {
namespace {

struct BenchOptions {
  std::vector<std::string> overrides;  ///< keys of the case
  std::string case_file;
  std::vector<double> sizes = {5e3, 17e3, 100e3, 1e6};
  std::vector<int> threads;
  std::vector<std::string> integrators = {"rk2", "leapfrog"}, yields = {"elastic", "regularized"},
                           precisions = {"single", "double"};
  double seconds = 3.0, from = 0.0;
  bool json = false;
};

/// One measurement.
struct Setting {
  double particles;  ///< soil and wall together, wanted
  int threads;
  std::string integrator, yield, precision;
};

/// The first of each list is the base; one at a time is varied.
std::vector<Setting> settings(const BenchOptions& o, double base_size) {
  const Setting base{base_size, o.threads.front(), o.integrators.front(), o.yields.front(), o.precisions.front()};
  std::vector<Setting> all = {base};
  const auto vary = [&](const auto& values, auto Setting::*member) {
    for (const auto& value : values) {
      Setting s = base;
      s.*member = value;
      if (s.*member != base.*member) all.push_back(s);
    }
  };
  vary(o.sizes, &Setting::particles);
  vary(o.threads, &Setting::threads);
  vary(o.integrators, &Setting::integrator);
  vary(o.yields, &Setting::yield);
  vary(o.precisions, &Setting::precision);
  return all;
}

Json load_document(const BenchOptions& o) {
  if (o.case_file.empty()) return Json::parse(cases().front().second);
  return load_case(o.case_file).resolved;
}

/// The case at another number of particles.
Model model_of(const BenchOptions& o, const Json& document, const Setting& s) {
  const auto directory = std::filesystem::path(o.case_file).parent_path();
  const auto at_spacing = [&](double dx) {
    char spacing[64];
    std::snprintf(spacing, sizeof spacing, "particle_spacing_m=%.9g", dx);
    std::vector<std::string> overrides = o.overrides;
    overrides.insert(overrides.end(), {spacing, "numerics.integrator=" + s.integrator, "rheology.yield=" + s.yield,
                                       "numerics.precision=" + s.precision, "max_particles=8000000"});
    return load_case(document, directory, overrides).value.model;
  };
  double dx = document.at("particle_spacing_m").get<double>();
  // The soil grows with 1/dx^2, the walls with 1/dx: a few rounds settle both.
  for (int round = 0; round < 4; ++round) {
    const ParticlePlan plan = plan_particles(at_spacing(dx));
    const double found = static_cast<double>(plan.soil.size() + plan.walls.size());
    if (std::abs(found / s.particles - 1.0) < 0.002) break;
    dx *= std::sqrt(found / s.particles);
  }
  return at_spacing(dx);
}

/// Memory of this process that is in use [bytes].
double resident() {
  std::ifstream statm("/proc/self/statm");
  double pages = 0.0, in_use = 0.0;
  statm >> pages >> in_use;
  return in_use * static_cast<double>(sysconf(_SC_PAGESIZE));
}

/// Soil and walls within 2h of a soil particle, on average, itself left out.
double mean_neighbours(const Simulation& simulation) {
  const double reach = 2.0 * simulation.constants().h;
  const Soil& soil = simulation.soil();
  const auto count = [&](const auto& points) {
    CellList cells;
    cells.build(points.x, points.y, reach);
    const auto order = cells.order();
    std::int64_t near = 0;
#pragma omp parallel for reduction(+ : near)
    for (std::size_t i = 0; i < soil.n_active; ++i)
      cells.for_ranges(soil.position(i), [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k)
          near += norm2(points.position(order[k]) - soil.position(i)) < reach * reach;
      });
    return static_cast<double>(near);
  };
  return (count(soil) + count(simulation.walls())) / static_cast<double>(soil.n_active) - 1.0;
}

Json measure(const BenchOptions& o, const Json& document, const Setting& s) {
  omp_set_num_threads(s.threads);
  const double before = resident();
  const Model model = model_of(o, document, s);
  std::optional<Simulation> made;
  made.emplace(model, plan_particles(model));
  Simulation& simulation = *made;
  while (simulation.time() < o.from && !simulation.finished()) simulation.step(o.from);
  for (int k = 0; k < 3; ++k) simulation.step(model.time.end);
  const double n = static_cast<double>(simulation.soil().size() + simulation.walls().size());
  // Blocks of steps; the middle one counts, so that a disturbance of the machine does not.
  const double block = o.seconds / 9.0;
  std::vector<double> step_seconds;
  const StageTimes start = simulation.times();
  double spent = 0.0;
  std::int64_t steps = 0;
  const RunResult first = simulation.result();
  while ((spent < o.seconds || step_seconds.size() < 3) && !simulation.finished()) {
    double taken = 0.0;
    Stopwatch watch;
    int made_here = 0;
    for (; taken < block && !simulation.finished(); ++made_here) {
      simulation.step(model.time.end);
      watch.lap(taken);
    }
    step_seconds.push_back(taken / made_here);
    spent += taken;
    steps += made_here;
  }
  std::ranges::sort(step_seconds);
  const double per_step = step_seconds[step_seconds.size() / 2], evaluations = s.integrator == "rk2" ? 2.0 : 1.0;
  const double bytes = (resident() - before) / n;
  Json run = {{"particles", simulation.soil().size() + simulation.walls().size()},
              {"soil", simulation.soil().size()},
              {"threads", s.threads},
              {"integrator", s.integrator},
              {"yield", s.yield},
              {"precision", s.precision},
              {"backend", simulation.backend()},
              {"simd", simulation.simd()},
              {"neighbours", mean_neighbours(simulation)},
              {"steps", steps},
              {"seconds", spent},
              {"evaluations_per_second_per_core", n * evaluations / per_step / s.threads},
              {"particle_steps_per_second_per_core", n / per_step / s.threads},
              {"best_evaluations_per_second_per_core", n * evaluations / step_seconds.front() / s.threads},
              {"bytes_per_particle", bytes}};
  const StageTimes end = simulation.times();
  const double total = end.total() - start.total();
  for (const auto& [name, stage] : {std::pair{"sort", &StageTimes::sort},
                                    {"lists", &StageTimes::lists},
                                    {"gradient", &StageTimes::gradient},
                                    {"walls", &StageTimes::walls},
                                    {"momentum", &StageTimes::momentum},
                                    {"update", &StageTimes::update}})
    run["share"][name] = (end.*stage - start.*stage) / total;
  return run;
}

/// Every measurement in a process of its own, so that none inherits the memory or the threads of another.
Json measure_apart(const BenchOptions& o, const Json& document, const Setting& s) {
  std::array<int, 2> pipe_ends;
  if (pipe(pipe_ends.data()) != 0) throw IoError("no pipe for a measurement");
  const pid_t child = fork();
  if (child < 0) throw IoError("no process for a measurement");
  if (child == 0) {
    close(pipe_ends[0]);
    std::string text;
    try {
      text = measure(o, document, s).dump();
    } catch (const std::exception& e) {
      text = Json{{"error", e.what()}}.dump();
    }
    const bool told = write(pipe_ends[1], text.data(), text.size()) == static_cast<ssize_t>(text.size());
    _exit(told ? 0 : 1);
  }
  close(pipe_ends[1]);
  std::string text;
  std::array<char, 4096> buffer;
  for (ssize_t got; (got = read(pipe_ends[0], buffer.data(), buffer.size())) > 0;)
    text.append(buffer.data(), static_cast<std::size_t>(got));
  close(pipe_ends[0]);
  waitpid(child, nullptr, 0);
  const Json run = Json::parse(text, nullptr, false);
  if (run.is_discarded())
    throw IoError("a measurement of " + std::to_string(s.particles) + " particles died; is there memory enough?");
  if (run.contains("error")) throw ConfigError("", run["error"].get<std::string>());
  return run;
}

void print_header() {
  std::printf("%9s %7s %-8s %-11s %-6s %-9s %6s  %9s %9s  %7s   %s\n%73s %9s  %8s\n", "particles", "threads",
              "steps by", "yield", "prec.", "SIMD", "neigh.", "M eval/s", "M steps/s", "bytes/",
              "share of time [%]: sort lists gradient walls momentum update", "per core", "per core", "particle");
}

void print_row(const Json& r) {
  const auto word = [&](const char* key) { return r[key].get_ref<const std::string&>().c_str(); };
  const auto number = [&](const char* key) { return r[key].get<double>(); };
  std::printf("%9.0f %7.0f %-8s %-11s %-6s %-9s %6.1f  %9.2f %9.2f  %7.0f  ", number("particles"), number("threads"),
              word("integrator"), word("yield"), word("precision"), word("simd"), number("neighbours"),
              1e-6 * number("evaluations_per_second_per_core"), 1e-6 * number("particle_steps_per_second_per_core"),
              number("bytes_per_particle"));
  for (const auto& share : r["share"]) std::printf(" %.1f", 100.0 * share.get<double>());
  std::printf("\n");
  std::fflush(stdout);
}

std::string processor() {
  std::ifstream cpuinfo("/proc/cpuinfo");
  for (std::string line; std::getline(cpuinfo, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown";
}

Exit bench(BenchOptions o) {
  if (o.threads.empty()) {
    o.threads = {1};
    if (const int all = static_cast<int>(std::thread::hardware_concurrency()); all > 1) o.threads.push_back(all);
  }
  const Json document = load_document(o);
  // Of the default sizes the paper's is the base.
  const double base = std::ranges::count(o.sizes, 17e3) ? 17e3 : o.sizes.front();
  Json out = {{"version", version},           {"compiler", TALUS_COMPILER},
              {"processor", processor()},     {"cores", std::thread::hardware_concurrency()},
              {"case", document.at("title")}, {"from_s", o.from},
              {"runs", Json::array()}};
  if (!o.json) {
    std::printf("talus %s, %s, %s with %u cores; case \"%s\" from %g s\n", version.c_str(), TALUS_COMPILER,
                processor().c_str(), std::thread::hardware_concurrency(),
                document.at("title").get<std::string>().c_str(), o.from);
    print_header();
  }
  for (const Setting& s : settings(o, base)) {
    out["runs"].push_back(measure_apart(o, document, s));
    if (!o.json) print_row(out["runs"].back());
  }
  if (o.json) std::cout << out.dump(2) << "\n";
  return Exit::ok;
}

}  // namespace

void add_bench(CLI::App& app, Action& action) {
  const auto o = std::make_shared<BenchOptions>();
  CLI::App* verb = app.add_subcommand("bench", "Measure the speed of the solver on this machine");
  verb->add_option("CASE", o->case_file, "Case file (JSON); default: the illustrative slope");
  add_overrides(*verb, o->overrides);
  const auto american = [](const std::string& word) -> std::string {
    return word == "regularised" ? "regularized" : word;
  };
  verb->add_option("--sizes", o->sizes,
                   "Numbers of particles, walls included; the first is the base, from which one "
                   "setting at a time is varied")
      ->delimiter(',')
      ->check(CLI::Range(100.0, 8e6));
  verb->add_option("--threads", o->threads, "Numbers of OpenMP threads; default: 1 and all cores")
      ->delimiter(',')
      ->check(CLI::Range(1, 4096));
  verb->add_option("--integrators", o->integrators, "Integrators")
      ->type_name("NAME")
      ->delimiter(',')
      ->check(CLI::IsMember({"rk2", "leapfrog"}));
  verb->add_option("--yields", o->yields, "Yield laws")
      ->type_name("NAME")
      ->delimiter(',')
      ->check(CLI::IsMember({"elastic", "regularized"}))
      ->transform(american);
  verb->add_option("--precisions", o->precisions, "Precisions")
      ->type_name("NAME")
      ->delimiter(',')
      ->check(CLI::IsMember({"single", "double"}));
  verb->add_option("--seconds", o->seconds, "Duration of each measurement [s]")->check(CLI::Range(0.01, 3600.0));
  verb->add_option("--from", o->from, "Simulated time before the measurement begins [s]")->check(CLI::Range(0.0, 1e6));
  verb->add_flag("--json", o->json, "Print the measurements as JSON");
  set_footer(*verb, {exit_text::bad_case, exit_text::io}, {"bench --sizes 17000 --threads 1 --seconds 10"});
  verb->callback([&action, o] { action = [o] { return bench(*o); }; });
}

}  // namespace talus::cli
