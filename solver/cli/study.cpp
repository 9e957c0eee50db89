// talus study: many realizations, each a process of its own, and what they say together.

#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>
#include <thread>

#include "case/load.hpp"
#include "cli/help.hpp"
#include "cli/progress.hpp"
#include "cli/signals.hpp"
#include "cli/verbs.hpp"
#include "executor/slurm.hpp"
#include "executor/slurm_batch.hpp"
#include "figures/figures.hpp"
#include "run/drawn_numbers.hpp"
#include "run/warnings.hpp"
#include "study/run_study.hpp"
#include "support/files.hpp"
#include "support/seed.hpp"
#include "support/text.hpp"

namespace talus::cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::size_t max_summary_bytes = std::size_t{256} << 20;

struct StudyOptions {
  fs::path case_file, out;
  std::vector<std::string> overrides;
  std::optional<std::int64_t> realizations;
  std::optional<std::uint64_t> seed;
  std::optional<int> workers;
  std::vector<std::int64_t> range;  ///< first and last, both included
  int threads = 1;
  int attempts = default_attempts;
  std::uint64_t time_limit = 0, stall_limit = 60;  // [s]
  std::string executor = "local";
  fs::path slurm;  ///< its configuration; empty: the defaults
  bool json = false, resume = false, retry_failed = false, no_figures = false, prepare = false;
};

/// Progress on stderr: one line that is redrawn on a terminal, a plain line now and then elsewhere.
class Reporter {
 public:
  void show(const Progress& progress) {
    if (terminal_)
      std::cerr << "\r" << painted(progress_bar(progress, terminal_width() - 1)) << "\033[K" << std::flush;
    else if (const auto now = Clock::now(); differs(progress) && now - shown_at_ >= std::chrono::seconds(10)) {
      std::cerr << progress_line(progress) << "\n";
      shown_at_ = now;
      shown_ = progress;
    }
    last_ = progress;
  }
  void note(const std::string& text) { std::cerr << (terminal_ ? "\r\033[K" : "") << text << "\n"; }
  /// Leaves the last state on a line of its own.
  ~Reporter() {
    if (last_) note(progress_line(*last_));
  }

 private:
  bool differs(const Progress& progress) const {
    return progress.made_now != shown_.made_now || progress.pending_reason != shown_.pending_reason;
  }
  /// The bar in green, where colours are wanted (https://no-color.org).
  static std::string painted(const std::string& line) {
    const char* no_color = std::getenv("NO_COLOR");
    const std::size_t end = line.find(']');
    if ((no_color && *no_color) || end == std::string::npos) return line;
    return "\033[32m" + line.substr(0, end + 1) + "\033[0m" + line.substr(end + 1);
  }

  bool terminal_ = ::isatty(STDERR_FILENO) != 0;
  std::optional<Progress> last_;
  Progress shown_;  ///< the last one that was shown
  Clock::time_point shown_at_ = Clock::now();
};

/// --seed, else the case's, else that of the study already begun in --out, else random_seed().
std::uint64_t choose_seed(const StudyOptions& options, const Case& problem) {
  if (options.seed) return *options.seed;
  if (problem.study.seed) return *problem.study.seed;
  const std::optional<Plan> begun = find_plan(options.out);
  return begun ? begun->seed : random_seed();
}

/// Array jobs of Slurm instead of processes here.
void use_slurm(RunStudyOptions& run, const StudyOptions& options, Reporter& reporter) {
  const auto config = options.slurm.empty() ? executor::SlurmConfig{} : executor::read_slurm_config(options.slurm);
  const std::vector<std::string> array_task{run.program.front(), "array-task"};
  const auto note = [&reporter](const std::string& text) { reporter.note(text); };
  run.make_executor = [=, threads = run.threads](const StudyPaths& paths) {
    return std::make_unique<executor::SlurmExecutor>(config, fs::absolute(paths.work()) / "slurm", array_task, threads,
                                                     note);
  };
}

RunStudyOptions run_options(const StudyOptions& options, const Plan& plan, Reporter& reporter) {
  RunStudyOptions run;
  run.program = {fs::read_symlink("/proc/self/exe").string(), "run"};
  run.threads = options.threads;
  run.attempts = options.attempts;
  run.time_limit_s = options.time_limit;
  run.stall_limit_s = options.stall_limit;
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  run.workers = options.workers.value_or(std::max(1, cores / options.threads));
  if (!options.range.empty()) {
    if (plan.study.stop_half_width)
      throw ConfigError("/study/stop_when_ci_half_width_below_m",
                        "only a whole study can stop early; remove this key or --range");
    run.first = options.range.front();
    run.last = options.range.back() + 1;
  }
  run.resume = options.resume;
  run.retry_failed = options.retry_failed;
  run.interrupts = [] { return stop_requested() ? 1 : 0; };
  run.report = [&reporter](const Progress& progress) { reporter.show(progress); };
  run.note = [&reporter](const std::string& text) { reporter.note(text); };
  if (options.executor == "slurm") use_slurm(run, options, reporter);
  return run;
}

void print(const fs::path& directory, bool json) {
  const std::string text = read_file(StudyPaths{directory}.summary(), max_summary_bytes);
  std::cout << (json ? text : study_report(Json::parse(text)));
}

Exit exit_code(StudyEnd end) {
  if (end == StudyEnd::interrupted) return Exit::interrupted;
  return end == StudyEnd::too_many_failed ? Exit::too_many_failed : Exit::ok;
}

Exit study(const StudyOptions& options) try {
  if (!options.range.empty() && options.range.front() > options.range.back()) {
    std::cerr << "--range: the first realization comes after the last\n";
    return Exit::usage;
  }
  std::vector<std::string> overrides = options.overrides;
  if (options.realizations) overrides.push_back("study.realizations=" + std::to_string(*options.realizations));
  LoadedCase loaded = load_case(options.case_file, overrides);
  std::ranges::move(warnings_before_run(loaded.value), std::back_inserter(loaded.warnings));
  print_warnings(loaded.warnings);
  Plan plan = make_plan(loaded, choose_seed(options, loaded.value), version);
  plan.draws = drawn_numbers(loaded.value);
  loaded.resolved["study"]["seed"] = plan.seed;
  if (options.prepare) {
    prepare_study(plan, loaded.resolved, options.out);
    return Exit::ok;
  }

  catch_stop_signals();
  StudyEnd end{};
  {
    Reporter reporter;
    end = run_study(plan, loaded.resolved, options.out, run_options(options, plan, reporter));
  }
  const Exit code = exit_code(end);
  if (end == StudyEnd::interrupted) std::cerr << "stopped; the same command goes on where it was\n";
  if (end == StudyEnd::too_many_failed)
    std::cerr << "more realizations failed than study.max_failed_share = " << plan.study.max_failed_share
              << " allows; see " << StudyPaths{options.out}.realizations().string() << "\n";
  if (end != StudyEnd::interrupted && !options.no_figures) draw_figures(options.out, plot_study);
  print(options.out, options.json);
  return code;
} catch (const executor::SlurmConfigError& e) {
  std::cerr << e.what() << "\n";
  return Exit::usage;
}

}  // namespace

void add_study(CLI::App& app, Action& action) {
  auto options = std::make_shared<StudyOptions>();
  CLI::App* verb = app.add_subcommand(
      "study", "Run many realizations: realizations.csv, study.json, figures; the same command continues after a stop");
  add_case(*verb, options->case_file);
  verb->add_option("--out", options->out, "Directory for the results; created, empty, or holding this study")
      ->type_name("DIR")
      ->required();
  verb->add_option("--realizations", options->realizations, "Number of realizations; default: study.realizations")
      ->check(CLI::Range(1, 1'000'000'000));
  verb->add_option("--seed", options->seed,
                   "Seed of the random fields; default: the case's, else a random one, which is recorded")
      ->check(CLI::Range(std::int64_t{0}, max_exact_integer));
  verb->add_option("--workers", options->workers, "Processes at a time; default: cores / threads")
      ->check(CLI::Range(1, 4096));
  verb->add_option("--threads", options->threads, "OpenMP threads of each process; default: 1")
      ->check(CLI::Range(1, 4096));
  verb->add_option("--attempts", options->attempts, "Number of crashes after which a realization counts as failed")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  verb->add_option("--time-limit", options->time_limit,
                   "Wall-clock limit of a realization [s], which fails beyond it; default: none")
      ->check(CLI::Range(1, 30 * 86400));
  verb->add_option("--stall-limit", options->stall_limit,
                   "Time without any use of the CPU after which a realization counts as hung and is run again [s]; "
                   "0: never")
      ->check(CLI::Range(0, 86400))
      ->capture_default_str();
  verb->add_option("--executor", options->executor, "Where realizations run: local (here) or slurm (array jobs)")
      ->type_name("NAME")
      ->check(CLI::IsMember({"local", "slurm"}));
  verb->add_option("--slurm", options->slurm, "With --executor slurm: its configuration (deploy/slurm/slurm.json)")
      ->type_name("FILE");
  add_overrides(*verb, options->overrides);
  verb->add_option("--range", options->range,
                   "Run only realizations FIRST to LAST here, the others elsewhere; merge with talus stats")
      ->expected(2)
      ->type_name("FIRST LAST")
      ->check(CLI::NonNegativeNumber);
  verb->add_flag("--resume", options->resume,
                 "Also continue a study of an earlier time.end_s: the runs that had not come to rest are run again");
  verb->add_flag("--retry-failed", options->retry_failed, "Run the failed realizations again");
  verb->add_flag("--no-figures", options->no_figures, "Draw no figures at the end");
  verb->add_flag("--prepare", options->prepare, "Only write plan and case, for others to run (talusd does)");
  verb->add_flag("--json", options->json, "Print study.json on stdout");
  set_footer(*verb, {exit_text::bad_case, exit_text::io, exit_text::stopped, exit_text::failed},
             {"study slope.json --realizations 200 --out study",
              "study slope.json --range 0 499 --seed 1 --realizations 1000 --out here"});
  verb->callback([options, &action] {
    if (options->executor == "slurm") options->out = fs::absolute(options->out);  // tasks begin in another directory
    action = [options] { return study(*options); };
  });
}

/// What `--executor slurm` lets Slurm start on its machines.
void add_array_task(CLI::App& app, Action& action) {
  const auto batch = std::make_shared<fs::path>();
  CLI::App* verb = app.add_subcommand("array-task", "execute the runs of one task of an array job")->group("");
  verb->add_option("batch", *batch, "directory of the batch")->required();
  verb->callback([batch, &action] {
    action = [batch] { return static_cast<Exit>(executor::execute_array_task(executor::BatchDirectory(*batch))); };
  });
}

}  // namespace talus::cli
