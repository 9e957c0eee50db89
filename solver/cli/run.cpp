// talus run: one realization from a case file to result.json, snapshots and history.

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <iostream>
#include <optional>
#include <utility>

#include "case/load.hpp"
#include "cli/help.hpp"
#include "cli/signals.hpp"
#include "cli/verbs.hpp"
#include "figures/figures.hpp"
#include "math/angle.hpp"
#include "run/run_realization.hpp"
#include "support/files.hpp"
#include "support/text.hpp"

namespace talus::cli {
namespace {

namespace fs = std::filesystem;

struct RunOptions {
  fs::path case_file, out;
  std::vector<std::string> overrides;
  std::optional<std::int64_t> realization;
  std::optional<std::uint64_t> seed;
  std::optional<double> perturbation;
  std::optional<int> threads;
  bool resume = false, figures = false, json = false, study_worker = false;
};

/// One line that is redrawn, on a terminal only.
class ProgressLine {
 public:
  explicit ProgressLine(bool on) : on_(on && isatty(STDERR_FILENO) != 0) {}
  ~ProgressLine() { clear(); }
  void clear() {
    if (shown_) std::fputs("\r\033[K", stderr);
    shown_ = false;
  }
  void show(const Simulation& simulation, double end, double elapsed) {
    if (!on_ || elapsed < next_) return;
    next_ = elapsed + 0.2;
    const double share = simulation.time() / end;
    std::fprintf(stderr, "\r\033[K%5.1f %%  t = %.2f of %g s  farthest particle %.2f m  %.0f s left at most",
                 100.0 * share, simulation.time(), end, simulation.history_row().front,
                 share > 0.0 ? elapsed * (1.0 - share) / share : 0.0);
    std::fflush(stderr);
    shown_ = true;
  }

 private:
  bool on_, shown_ = false;
  double next_ = 0.5;
};

/// "30.254"; ">=30.254" of a lower bound, "-" of none.
std::string value_text(const RunResult& r, const Measure& measure) {
  const double value = r.measures.*measure.member;
  if (std::isnan(value)) return "-";
  const bool lower_bound = std::ranges::find(r.lower_bounds, measure.key) != r.lower_bounds.end();
  char text[32];
  std::snprintf(text, sizeof text, "%s%.3f", lower_bound ? ">=" : "", value);
  return text;
}

/// What is printed behind the value of a measure.
std::string remark_on(const RunResult& r, const Measure& measure) {
  if (&measure == &leading_measure) return std::string("   the run-out distance (") + measure.key + ")";
  if (&measure == measure_table.data()) return std::string("   the paper's influence zone (") + measure.key + ")";
  if (measure.member != &Measures::front_at_thickness || r.front_thickness <= 0.0) return "";
  return "   where the soil is " + rounded(r.front_thickness) + " m thick";
}

/// What the slide did to a target, in one line.
std::string target_text(const TargetOutcome& target) {
  if (!target.arrives) return target.open ? "not reached yet, the soil still moves" : "not reached";
  std::string text = "reached after " + rounded(target.arrival) + " s: depth " + rounded(target.peak_depth) +
                     " m, speed " + rounded(target.peak_speed) + " m/s, dynamic pressure " +
                     rounded(1e-3 * target.peak_dynamic_pressure) + " kPa";
  if (target.of.kind == TargetKind::structure)
    text += ", force " + rounded(1e-3 * target.peak_horizontal_force) + " kN/m, overturning moment " +
            rounded(1e-3 * target.peak_overturning_moment) + " kN m/m";
  return text + (target.open ? "; the soil still moves there" : "");
}

void print_summary(const RunResult& r, const RunOutAxis& axis, std::uint64_t seed) {
  std::fputs(verdict_lines(r.quality).c_str(), stdout);
  std::printf("distances from x = %.10g m to the %s\n", axis.from, axis.to == SlidesTo::right ? "right" : "left");
  for (const Measure* measure : reading_order())
    std::printf("%-26s%10s %s%s\n", ((measure->front ? "front, " : "") + std::string(measure->label)).c_str(),
                value_text(r, *measure).c_str(), measure->unit, remark_on(r, *measure).c_str());
  for (const std::string& note : r.notes) std::printf("note: %s\n", note.c_str());
  for (const TargetOutcome& target : r.targets)
    std::printf("%-26s%s\n", target.of.name.c_str(), target_text(target).c_str());
  std::printf("time reached              %10.3f s   in %lld steps%s\n", r.time, static_cast<long long>(r.steps),
              r.at_rest ? ", at rest" : "");
  if (const std::optional<double> share = r.energy.numerical_share())
    std::printf("numerical dissipation     %10.1f %%   of gravity's work, taken by the method instead of the soil\n",
                100.0 * *share);
  std::printf("particles                 %10lld soil + %lld wall, %lld penetrated\n", static_cast<long long>(r.soil),
              static_cast<long long>(r.wall), static_cast<long long>(r.penetrated));
  if (r.left_domain > 0)
    std::printf("left the terrain          %10lld particles\n", static_cast<long long>(r.left_domain));
  if (r.field.terms > 0)
    std::printf(
        "random field              %10lld terms, %.1f %% of the variance, mean friction angle %.2f deg, seed %llu\n"
        "COV of tan(phi)           %10.3g\n",
        static_cast<long long>(r.field.terms), 100.0 * r.field.captured_variance, degrees(r.field.mean_phi),
        static_cast<unsigned long long>(seed), r.field.cov);
  for (const PropertySummary& p : r.field.properties)
    std::printf("%-26s%10.4g %s   in this run; drawn with mean %.4g, COV %.3g\n", p.name.c_str(), p.run_mean,
                std::string(std::ranges::find(property_names, p.name, &PropertyName::key)->unit).c_str(), p.mean,
                p.cov);
  std::printf("wall clock                %10.2f s   on %d thread%s\ndigest                    %s\n", r.wall_clock,
              r.threads, r.threads == 1 ? "" : "s", r.digest.c_str());
}

Exit run(const RunOptions& options) {
  if (options.study_worker && !die_with_parent()) return Exit::interrupted;
  const bool verbose = !options.json && !options.study_worker;
  LoadedCase loaded = load_case(options.case_file, options.overrides);
  const double end = loaded.value.model.time.end;
  const std::uint64_t seed = choose_seed(options.seed, loaded, options.out);

  ProgressLine progress(verbose);
  const auto say_continued = [&](double time) {
    if (!options.study_worker) std::cerr << "continues from t = " << time << " s\n";
  };
  const RunHooks hooks{.stop_requested = stop_requested,
                       .show_progress = [&](const Simulation& s, double elapsed) { progress.show(s, end, elapsed); },
                       .continued = say_continued,
                       .warn =
                           [&](const std::vector<Fault>& warnings) {
                             if (!options.study_worker) print_warnings(warnings);
                           }};
  catch_stop_signals(!options.study_worker);
  RunOutAxis axis = loaded.value.model.terrain.run_out;
  axis.from += loaded.value.model.terrain.origin.x;
  const RunOutcome outcome = run_realization(std::move(loaded),
                                             {.directory = options.out,
                                              .resume = options.resume,
                                              .keep_final_state = !options.study_worker,
                                              .seed = seed,
                                              .realization = options.realization,
                                              .perturbation = options.perturbation,
                                              .threads = options.threads,
                                              .version = version},
                                             hooks);
  progress.clear();
  if (!outcome.finished) {
    if (!options.study_worker)
      std::cerr << "stopped at t = " << outcome.time << " s with a checkpoint; the same command continues it\n";
    return Exit::interrupted;
  }
  if (options.json) std::cout << outcome.document;
  if (verbose) print_summary(outcome.result, axis, seed);
  if (options.json && !options.study_worker) std::cerr << verdict_lines(outcome.result.quality);
  if (options.figures) draw_figures(options.out, plot_run);
  return Exit::ok;
}

}  // namespace

void add_run(CLI::App& app, Action& action) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* verb =
      app.add_subcommand("run", "Run one realization: result.json, case.resolved.json, snapshots.vtkhdf, history.csv");
  add_case(*verb, options->case_file);
  verb->add_option("--out", options->out, "Directory for the results; created, or empty")->type_name("DIR")->required();
  verb->add_option("--realization", options->realization, "Index of the realization, from 0; without it the median run")
      ->check(CLI::NonNegativeNumber);
  verb->add_option("--seed", options->seed,
                   "Seed of the random field; default: the case's, else a random one, which is recorded")
      ->check(CLI::Range(std::int64_t{0}, max_exact_integer));  // what every reader of JSON keeps exact
  verb->add_option(
          "--threads", options->threads,
          "OpenMP threads; by default one for every 2000 particles, fewer on a busy machine; the result does not "
          "depend on them")
      ->check(CLI::Range(1, 4096));
  add_overrides(*verb, options->overrides);
  verb->add_flag("--resume", options->resume,
                 "Accept a finished run in --out; with a later time.end_s, continue one that still moved");
  verb->add_flag("--figures", options->figures, "Draw profiles at the snapshot times");
  verb->add_flag("--json", options->json, "Print result.json on stdout");
  set_footer(*verb, {exit_text::bad_case, exit_text::diverged, exit_text::io, exit_text::stopped},
             {"run slope.json --out run", "run slope.json --realization 7 --seed 42 --out run --figures"});
  verb->add_option("--perturbation", options->perturbation,
                   "relative change of tan(phi), for replicates that measure the numerical noise")
      ->group("");
  verb->add_flag("--study-worker", options->study_worker, "quiet, and dies with its parent")->group("");
  verb->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace talus::cli
