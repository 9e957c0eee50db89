#include "run/run_realization.hpp"

#include <omp.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <iterator>
#include <nlohmann/json.hpp>

#include "io/checkpoint.hpp"
#include "io/result_json.hpp"
#include "run/dissipation.hpp"
#include "run/recorder.hpp"
#include "run/thread_choice.hpp"
#include "run/warnings.hpp"
#include "support/error.hpp"
#include "support/files.hpp"
#include "support/output_directory.hpp"
#include "support/seed.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr double checkpoint_period = 60.0;  ///< seconds of wall clock that a kill -9 may cost
constexpr std::size_t max_result_bytes = std::size_t{1} << 20, max_case_bytes = std::size_t{64} << 20;

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));
  return text;
}

/// The finished run of a directory, if it is the one that is asked for.
RunOutcome finished_run(const fs::path& directory, const RunRequest& request) {
  const fs::path file = directory / "result.json";
  const auto [result, of] = read_result(file);
  if (of.seed != request.seed || of.realization != request.realization || of.perturbation != request.perturbation)
    throw IoError(directory.string() + " holds the finished run of another seed or realization; choose another --out");
  return {true, result.time, result, read_file(file, max_result_bytes)};
}

}  // namespace

std::uint64_t choose_seed(std::optional<std::uint64_t> given, const LoadedCase& loaded, const fs::path& directory) {
  if (given) return *given;
  const fs::path earlier = directory / "case.resolved.json";
  if (fs::exists(earlier)) {
    const auto document = nlohmann::json::parse(read_file(earlier, max_case_bytes), nullptr, false);
    const nlohmann::json::json_pointer seed("/study/seed");
    if (!document.is_discarded() && document.contains(seed) && document[seed].is_number_unsigned())
      return document[seed];
  }
  if (loaded.value.study.seed) return *loaded.value.study.seed;
  return random_seed();
}

RunOutcome run_realization(LoadedCase loaded, const RunRequest& request, const RunHooks& hooks) {
  const Clock::time_point begin = Clock::now();
  const auto elapsed = [begin] { return std::chrono::duration<double>(Clock::now() - begin).count(); };  // [s]
  double earlier = 0.0;  // wall clock of the processes that this one continues [s]
  const Case& problem = loaded.value;
  const RunIdentity identity{request.seed, request.realization, request.perturbation.value_or(0.0)};
  loaded.resolved["study"]["seed"] = request.seed;

  const ParticlePlan plan = plan_particles(problem.model);
  ThreadChoice threads(plan.soil.size() + plan.walls.size(), omp_get_max_threads(), request.threads);
  omp_set_num_threads(threads.count());
  const Strength soil = strength(problem.model, problem.field, problem.study, plan, identity);
  const CaseIdentity of{loaded.hash, loaded.hash_without_end, problem.model.time.end};
  OutputDirectory out(request.directory, OutputKind::run, of, request.resume);
  if (out.finished()) return finished_run(out.path(), request);

  const Provenance provenance{request.version, request.seed,  request.realization, request.perturbation,
                              loaded.hash,     problem.title, TALUS_COMPILER,      utc_now()};
  const CheckpointHeader header{request.version, loaded.hash_without_end, request.seed, request.realization,
                                request.perturbation};
  const fs::path checkpoint_file = out.path() / "checkpoint.h5";
  const bool resumed = fs::exists(checkpoint_file);
  if (out.extends()) {
    const bool done = fs::exists(out.path() / "result.json");
    if (done && !resumed)
      throw IoError(out.path().string() + " holds a run that came to rest before its end, t = " +
                    to_text(out.earlier_end()) + " s: there is nothing to continue");
  }
  std::ranges::move(warnings_before_run(problem, plan, soil.summary), std::back_inserter(loaded.warnings));
  hooks.warn(loaded.warnings);
  Simulation simulation(soil.model, plan, soil.properties);
  if (resumed) {
    const CheckpointState state = read_checkpoint(checkpoint_file, header);
    simulation.restore(state);
    earlier = state.wall_clock;
    hooks.continued(simulation.time());
  }
  if (out.extends()) {
    out.reopen();
    fs::remove(out.path() / "result.json");  // of the earlier end
  }
  write_file_atomically(out.path() / "case.resolved.json", loaded.resolved.dump(2) + "\n");
  Recorder recorder(out.path(), simulation, problem.model, provenance, resumed);
  const auto write_checkpoint_now = [&] {
    CheckpointState state = simulation.state();
    state.wall_clock = earlier + elapsed();
    recorder.write_history();
    recorder.wait_for_snapshot();
    write_checkpoint(checkpoint_file, state, header);
  };

  double next_checkpoint = checkpoint_period;
  try {
    while (!simulation.finished()) {
      if (hooks.stop_requested()) {
        write_checkpoint_now();
        return {false, simulation.time(), {}, {}};
      }
      const double before = elapsed();
      simulation.step(recorder.next_stop());
      threads.record(elapsed() - before);
      omp_set_num_threads(threads.count());
      recorder.record(simulation);
      hooks.show_progress(simulation, elapsed());
      if (elapsed() > next_checkpoint) {
        write_checkpoint_now();
        next_checkpoint = elapsed() + checkpoint_period;
      }
    }
  } catch (const DivergedError&) {
    recorder.write_history();
    throw;
  }
  recorder.finish(simulation);

  RunOutcome outcome{true, simulation.time(), simulation.result(), {}};
  outcome.result.wall_clock = earlier + elapsed();
  outcome.result.threads = threads.most_used();
  outcome.result.field = soil.summary;
  outcome.result.warnings = std::move(loaded.warnings);
  RunFacts facts = simulation.facts();
  facts.energy = outcome.result.energy;
  // With all coefficients zero, as in the median run, the field is uniform.
  if (std::ranges::any_of(soil.xi, [](double xi) { return xi != 0.0; }))
    facts.correlation_length = shortest_correlation(problem.field);
  const Measures& fronts = outcome.result.measures;
  if (lacks_rate_dependence(problem.model)) facts.separate_front = fronts.front_mass_99 - fronts.front_connected;
  outcome.result.quality = assess(facts);
  outcome.document = with_checksum(result_json(outcome.result, provenance));
  write_file_atomically(out.path() / "result.json", outcome.document);
  const bool moves = outcome.result.ending == Ending::end_time && !outcome.result.at_rest;
  if (request.keep_final_state && moves)
    write_checkpoint_now();
  else
    fs::remove(checkpoint_file);
  out.mark_finished();
  return outcome;
}

}  // namespace talus
