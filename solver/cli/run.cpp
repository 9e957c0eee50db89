// talus run: one realization from a case file to result.json, snapshots and history.

#include <omp.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <future>
#include <iostream>
#include <optional>
#include <utility>

#include "case/load.hpp"
#include "cli/help.hpp"
#include "cli/signals.hpp"
#include "cli/verbs.hpp"
#include "cli/version.hpp"
#include "figures/figures.hpp"
#include "io/checkpoint.hpp"
#include "io/history.hpp"
#include "io/result_json.hpp"
#include "io/vtkhdf.hpp"
#include "math/angle.hpp"
#include "monte_carlo/realization.hpp"
#include "simulation/simulation.hpp"
#include "support/files.hpp"
#include "support/output_directory.hpp"
#include "support/seed.hpp"
#include "support/text.hpp"

namespace talus::cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr double checkpoint_period = 60.0;  ///< seconds of wall clock that a kill -9 may cost
constexpr int history_rows = 500;

struct RunOptions {
  fs::path case_file, out;
  std::vector<std::string> overrides;
  std::optional<std::int64_t> realization;
  std::optional<std::uint64_t> seed;
  std::optional<double> perturbation;
  int threads = 0;
  bool resume = false, figures = false, json = false, study_worker = false;
};

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));
  return text;
}

/// --seed, else the interrupted run's own, else the case's, else random_seed().
std::uint64_t choose_seed(const RunOptions& options, const LoadedCase& loaded) {
  if (options.seed) return *options.seed;
  const fs::path earlier = options.out / "case.resolved.json";
  if (options.resume && fs::exists(earlier)) {
    const auto document = nlohmann::json::parse(read_file(earlier, 64u << 20), nullptr, false);
    const nlohmann::json::json_pointer seed("/study/seed");
    if (!document.is_discarded() && document.contains(seed) && document[seed].is_number_unsigned())
      return document[seed];
  }
  if (loaded.value.study.seed) return *loaded.value.study.seed;
  return random_seed();
}

/// The run's files and when each is due. Snapshots are written by a thread of their own, the first one too.
class Recorder {
 public:
  Recorder(const fs::path& directory, const Simulation& simulation, const Model& model, bool resumed)
      : history_file_(directory / "history.csv"),
        due_(model.time.snapshots),
        history_step_(model.time.end / history_rows) {
    const fs::path path = directory / "snapshots.vtkhdf";
    if (resumed)
      snapshots_.emplace(SnapshotWriter::resume(path, simulation.time()));
    else
      write([this, path, frame = simulation.frame()] { snapshots_.emplace(path, frame); });
    if (resumed && fs::exists(history_file_))
      for (const HistoryRow& row : read_history(history_file_))
        if (row.step <= simulation.steps()) history_.push_back(row);
    if (history_.empty()) history_.push_back(simulation.history_row());
    while (!due_.empty() && due_.front() <= simulation.time()) due_.erase(due_.begin());
  }

  /// To be called after every step. Snapshots are taken at the first step at or after their time: a step is never
  /// shortened for them.
  /// @throws IoError when a snapshot could not be written
  void record(const Simulation& simulation) {
    if (writing_.valid() && writing_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) writing_.get();
    if (simulation.time() >= history_.back().time + history_step_) history_.push_back(simulation.history_row());
    if (due_.empty() || simulation.time() < due_.front()) return;
    settle();
    write([this, frame = simulation.frame()] { snapshots_->append(frame); });
    while (!due_.empty() && due_.front() <= simulation.time()) due_.erase(due_.begin());
  }
  /// Waits until the last snapshot is in its file. To be called before anything else that uses HDF5.
  /// @throws IoError when it could not be written
  void settle() {
    if (writing_.valid()) writing_.get();
  }
  void write_history() const { talus::write_history(history_file_, history_); }
  void finish(const Simulation& simulation) {
    if (history_.back().step < simulation.steps()) history_.push_back(simulation.history_row());
    write_history();
    settle();
    snapshots_->append(simulation.frame());
    snapshots_->close();
  }

 private:
  /// Beside the run, which goes on.
  template <class Task>
  void write(Task&& task) {
    writing_ = std::async(std::launch::async, std::forward<Task>(task));
  }

  fs::path history_file_;
  std::optional<SnapshotWriter> snapshots_;
  std::vector<double> due_;
  double history_step_;
  std::vector<HistoryRow> history_;
  std::future<void> writing_;  ///< last member: it is waited for before the others go
};

/// One line that is redrawn, on a terminal only.
class ProgressLine {
 public:
  explicit ProgressLine(bool on) : on_(on && isatty(STDERR_FILENO) != 0) {}
  ~ProgressLine() {
    if (shown_) std::fputs("\r\033[K", stderr);
  }
  void show(const Simulation& simulation, double end, double elapsed) {
    if (!on_ || elapsed < next_) return;
    next_ = elapsed + 0.2;
    const double share = simulation.time() / end;
    std::fprintf(stderr, "\r\033[K%5.1f %%  t = %.2f of %g s  front %.2f m  %.0f s left at most", 100.0 * share,
                 simulation.time(), end, simulation.history_row().front,
                 share > 0.0 ? elapsed * (1.0 - share) / share : 0.0);
    std::fflush(stderr);
    shown_ = true;
  }

 private:
  bool on_, shown_ = false;
  double next_ = 0.5;
};

void print_summary(const RunResult& r, const RunIdentity& identity) {
  std::printf("influence zone        %10.3f m   (farthest particle from the left boundary)\n",
              r.measures.influence_zone);
  std::printf("front, connected body %10.3f m\n", r.measures.front_connected);
  std::printf("front, 99.9 %% of mass %10.3f m\n", r.measures.front_mass_999);
  std::printf("front, 99 %% of mass   %10.3f m\n", r.measures.front_mass_99);
  std::printf("centre of mass x      %10.3f m\n", r.measures.centre_of_mass_x);
  std::printf("time reached          %10.3f s   in %lld steps%s\n", r.time, static_cast<long long>(r.steps),
              r.at_rest ? ", at rest" : "");
  std::printf("particles             %10lld soil + %lld wall, %lld penetrated\n", static_cast<long long>(r.soil),
              static_cast<long long>(r.wall), static_cast<long long>(r.penetrated));
  if (r.left_domain > 0)
    std::printf("left the terrain      %10lld particles: fronts end where the bed ends\n",
                static_cast<long long>(r.left_domain));
  if (r.field.terms > 0)
    std::printf(
        "random field          %10lld terms, %.1f %% of the variance, mean friction angle %.2f deg, seed %llu\n",
        static_cast<long long>(r.field.terms), 100.0 * r.field.captured_variance, degrees(r.field.mean_phi),
        static_cast<unsigned long long>(identity.seed));
  std::printf("wall clock            %10.2f s   on %d thread%s\ndigest                %s\n", r.wall_clock, r.threads,
              r.threads == 1 ? "" : "s", r.digest.c_str());
}

/// The run itself is done; figures that cannot be drawn are no reason to fail.
void draw_figures(const fs::path& directory) try {
  plot_run(directory);
  std::cerr << "figures: " << (directory / "figures").string() << "\n";
} catch (const IoError& e) {
  std::cerr << "no figures: " << e.what() << "\n";
}

Exit run(const RunOptions& options) {
  if (options.study_worker && !die_with_parent()) return Exit::interrupted;
  const auto started = Clock::now();
  LoadedCase loaded = load_case(options.case_file, options.overrides);
  const Case& problem = loaded.value;
  const RunIdentity identity{choose_seed(options, loaded), options.realization, options.perturbation.value_or(0.0)};
  loaded.resolved["study"]["seed"] = identity.seed;
  if (options.threads > 0) omp_set_num_threads(options.threads);

  const ParticlePlan plan = plan_particles(problem.model);
  const Strength soil_strength = strength(problem.model, problem.field, problem.study, plan, identity);
  OutputDirectory out(options.out, OutputKind::run, loaded.hash, options.resume);
  const Provenance provenance{version(),   identity.seed, identity.realization, options.perturbation,
                              loaded.hash, problem.title, TALUS_COMPILER,       utc_now()};
  const fs::path result_file = out.path() / "result.json", checkpoint_file = out.path() / "checkpoint.h5";
  if (out.finished()) {
    const auto [result, of] = read_result(result_file);
    if (of.seed != identity.seed || of.realization != identity.realization || of.perturbation != options.perturbation)
      throw IoError(out.path().string() +
                    " holds the finished run of another seed or realization; choose another --out");
    if (options.json)
      std::cout << read_file(result_file, 1u << 20);
    else if (!options.study_worker)
      print_summary(result, identity);
    return Exit::ok;
  }

  Simulation simulation(problem.model, plan, soil_strength.tan_phi);
  const CheckpointHeader header{version(), loaded.hash, identity.seed, identity.realization, options.perturbation};
  if (!options.resume) fs::remove(checkpoint_file);  // of an unfinished run that is being started over
  const bool resumed = options.resume && fs::exists(checkpoint_file);
  double earlier = 0.0;  // wall clock of the run's earlier processes
  if (resumed) {
    const State state = read_checkpoint(checkpoint_file, header);
    simulation.restore(state);
    if (const auto clock = state.reals.find("wall_clock"); clock != state.reals.end() && clock->second.size() == 1)
      earlier = clock->second[0];
  }
  write_file_atomically(out.path() / "case.resolved.json", loaded.resolved.dump(2) + "\n");
  Recorder recorder(out.path(), simulation, problem.model, resumed);
  ProgressLine progress(!options.json && !options.study_worker);
  const auto checkpoint = [&] {
    State state = simulation.state();
    state.reals["wall_clock"] = {earlier + seconds_since(started)};
    recorder.write_history();
    recorder.settle();
    write_checkpoint(checkpoint_file, state, header);
  };

  catch_stop_signals(!options.study_worker);
  double next_checkpoint = checkpoint_period;
  try {
    while (!simulation.finished()) {
      if (stop_requested()) {
        checkpoint();
        if (!options.study_worker)
          std::cerr << "stopped at t = " << simulation.time()
                    << " s with a checkpoint; go on with the same command and --resume\n";
        return Exit::interrupted;
      }
      simulation.step(problem.model.time.end);
      recorder.record(simulation);
      const double elapsed = seconds_since(started);
      progress.show(simulation, problem.model.time.end, elapsed);
      if (elapsed > next_checkpoint) {
        checkpoint();
        next_checkpoint = seconds_since(started) + checkpoint_period;
      }
    }
  } catch (const DivergedError&) {
    recorder.write_history();
    throw;
  }
  recorder.finish(simulation);

  RunResult result = simulation.result();
  result.wall_clock = earlier + seconds_since(started);
  result.threads = omp_get_max_threads();
  result.field = soil_strength.summary;
  const std::string text = result_json(result, provenance).dump(2) + "\n";
  write_file_atomically(result_file, text);
  out.mark_finished();
  fs::remove(checkpoint_file);
  if (options.json)
    std::cout << text;
  else if (!options.study_worker)
    print_summary(result, identity);
  if (result.penetrated > 0 && !options.study_worker)
    std::cerr
        << "warning: " << result.penetrated
        << " particles passed through a wall: do not trust this run; try a smaller time step or more wall layers\n";
  if (options.figures) draw_figures(out.path());
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
  verb->add_option("--threads", options->threads, "OpenMP threads; the result does not depend on them")
      ->check(CLI::Range(1, 4096));
  add_overrides(*verb, options->overrides);
  verb->add_flag("--resume", options->resume, "Continue from the checkpoint in --out");
  verb->add_flag("--figures", options->figures, "Draw profiles at the snapshot times");
  verb->add_flag("--json", options->json, "Print result.json on stdout");
  set_footer(*verb, {exit_text::bad_case, exit_text::diverged, exit_text::io, exit_text::stopped},
             {"run slope.json --out run", "run slope.json --realization 7 --seed 42 --out run --figures"});
  verb->add_option("--perturbation", options->perturbation, "relative change of tan(phi), for noise-floor replicates")
      ->group("");
  verb->add_flag("--study-worker", options->study_worker, "quiet, and dies with its parent")->group("");
  verb->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace talus::cli
