#include "options.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>

#include "http/hosts.hpp"

namespace talus::service {
namespace {

namespace fs = std::filesystem;

/// "127.0.0.1:8080", "[::1]:0", "8080"
void split_listen(const std::string& text, Config& config) {
  const std::size_t colon = text.rfind(':');
  std::string host = colon == std::string::npos ? "127.0.0.1" : text.substr(0, colon);
  const std::string port = colon == std::string::npos ? text : text.substr(colon + 1);
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
  if (host.empty() || port.empty() || port.size() > 5 || port.find_first_not_of("0123456789") != std::string::npos ||
      std::stoi(port) > 65535)
    throw std::runtime_error("--listen must be ADDRESS:PORT");
  config.address = host;
  config.port = std::stoi(port);
}

/// The values of the options that Config holds in another form.
struct RawOptions {
  std::string listen = "127.0.0.1:8080", executor = "local";
  fs::path slurm;
  double min_disk_mib = 1024.0, body_mib = 4.0, traffic_mib = 64.0, memory_mib = 0.0;
  int time_limit = 6 * 3600, grace = 30, lease = 30;  // [s]
};

/// @throws std::runtime_error saying which option is wrong
void complete(Config& config, const RawOptions& raw) {
  constexpr double mib = 1048576.0;
  config.time_limit = std::chrono::seconds(raw.time_limit);
  config.grace = std::chrono::seconds(raw.grace);
  config.lease = std::chrono::seconds(raw.lease);
  config.body_bytes = static_cast<std::size_t>(raw.body_mib * mib);
  config.traffic_bytes = static_cast<std::size_t>(std::max(raw.traffic_mib, raw.body_mib) * mib);
  config.quotas.disk_bytes = static_cast<std::uint64_t>(raw.min_disk_mib * mib);
  // A negative value, no limit, is for sanitizers, which reserve terabytes of address space.
  if (raw.memory_mib != 0.0) config.memory_bytes = static_cast<std::uint64_t>(std::max(0.0, raw.memory_mib * mib));
  split_listen(raw.listen, config);
  if (!is_loopback(config.address) && config.tokens.empty())
    throw std::runtime_error("--listen " + config.address +
                             " is reachable from other hosts; it requires --tokens FILE");
  std::error_code error;
  if (!fs::exists(config.program, error))
    throw std::runtime_error((error ? "cannot examine " : "there is no ") + config.program.string() +
                             (error ? ": " + error.message() : "") + "; give --talus");
  if (raw.executor == "slurm")
    config.slurm = raw.slurm.empty() ? executor::SlurmConfig{} : executor::read_slurm_config(raw.slurm);
  config.program = fs::absolute(config.program);
}

}  // namespace

Options read_options(int argc, char** argv) {
  Options options;
  Config& config = options.config;
  std::error_code ignored;
  config.program = fs::read_symlink("/proc/self/exe", ignored).parent_path() / "talus";  // beside talusd
  RawOptions raw;

  CLI::App app{"talusd: Talus as a service", "talusd"};
  app.set_version_flag("--version", std::string("talusd ") + TALUS_VERSION);
  app.set_config("--config", "", "configuration file with the same options, one per line: name = value");
  /// An option whose default is shown by --help.
  const auto with_default = [&app](const char* name, auto& variable, const char* text) {
    return app.add_option(name, variable, text)->capture_default_str();
  };
  app.add_option("--data", config.data, "directory for the queue and all results; created if missing");
  with_default("--listen", raw.listen,
               "address and port to listen on; port 0 picks a free one; other than loopback requires --tokens");
  with_default("--executor", raw.executor, "where runs are executed: local (here) or slurm (array jobs)")
      ->check(CLI::IsMember({"local", "slurm"}));
  app.add_option("--slurm", raw.slurm, "configuration file of --executor slurm");
  with_default("--workers", config.workers, "number of concurrent runs with --executor local")
      ->check(CLI::Range(1, 1024));
  with_default("--threads", config.threads, "OpenMP threads per run")->check(CLI::Range(1, 1024));
  app.add_option("--tokens", config.tokens, "token file; requests without a valid token are rejected");
  app.add_option("--talus", config.program, "path of the talus program; default: the one beside talusd");
  app.add_option("--models", config.models, "directory of cases to serve over UM-Bridge");
  app.add_option("--public-url", config.public_url, "base URL of absolute links when talusd is behind a proxy");
  app.add_option("--host", config.hosts, "further host name under which talusd may be addressed; may be repeated");
  with_default("--attempts", config.attempts, "number of crashes after which a run counts as failed")
      ->check(CLI::Range(1, 100));
  with_default("--time-limit", raw.time_limit, "wall-clock limit of a run [s]")->check(CLI::Range(1, 30 * 86400));
  with_default("--grace", raw.grace, "time for runs to write a checkpoint when talusd is stopped [s]")
      ->check(CLI::Range(0, 3600));
  with_default("--lease", raw.lease, "time after which a run whose worker no longer responds is requeued [s]")
      ->check(CLI::Range(3, 3600));
  with_default("--memory", raw.memory_mib, "address-space limit of a run [MiB]; 0: from its size; negative: no limit");
  with_default("--nice", config.niceness, "niceness of runs")->check(CLI::Range(0, 19));
  with_default("--max-body", raw.body_mib, "MiB of a request")->check(CLI::Range(0.001, 1024.0));
  with_default("--max-traffic", raw.traffic_mib, "MiB of all requests and answers in memory")
      ->check(CLI::Range(1.0, 65536.0));
  with_default("--max-connections", config.connections,
               "maximum number of connections; an idle one gives way to a new one")
      ->check(CLI::Range(16, 65536));
  with_default("--max-connections-each", config.connections_each, "maximum number of connections from one address")
      ->check(CLI::Range(1, 65536));
  with_default("--max-streams", config.streams, "maximum number of open event streams")->check(CLI::Range(1, 4096));
  with_default("--max-streams-each", config.streams_each,
               "maximum number of open event streams per subject, with --tokens")
      ->check(CLI::Range(1, 4096));
  with_default("--http-threads", config.http_threads, "maximum number of requests answered at the same time")
      ->check(CLI::Range(1, 4096));
  with_default("--max-particles", config.quotas.particles, "maximum number of particles of a case");
  with_default("--max-steps", config.quotas.steps, "maximum number of time steps of a run");
  with_default("--max-realizations", config.quotas.realizations, "maximum number of realizations of a job")
      ->check(CLI::Range(1, 10'000'000));
  with_default("--max-core-hours", config.quotas.core_hours, "maximum estimated cost of a job [core hours]");
  with_default("--max-jobs", config.quotas.open_jobs, "maximum number of open jobs");
  with_default("--max-jobs-each", config.quotas.open_jobs_of_one, "maximum number of open jobs per subject");
  with_default("--min-disk", raw.min_disk_mib, "free disk space below which no job is accepted [MiB]")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--backup", options.backup,
                 "copy the queue and all jobs to this new directory, also while talusd runs, then exit");
  app.add_flag("--adopt", options.adopt, "take back jobs that the queue has lost from DATA/orphans, then exit");
  app.add_option("--new-token", options.new_token, "print a new token and its line for the token file, then exit")
      ->expected(2, 3)
      ->type_name("submit|read SUBJECT [EXPIRES]");
  app.footer(
      "Exit codes: 0 ok, 1 internal, 2 usage, 5 input/output (also when the data directory is in use, "
      "or memory or threads run out)");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    options.exit = app.exit(e) == 0 ? 0 : 2;
    return options;
  }
  if (!options.new_token.empty()) return options;
  try {
    if (config.data.empty()) throw std::runtime_error("--data DIR is required");
    config.data = fs::absolute(config.data);
    if (options.adopt || !options.backup.empty()) return options;
    complete(config, raw);
  } catch (const std::runtime_error& e) {
    std::cerr << "talusd: " << e.what() << "\n";
    options.exit = 2;
  }
  return options;
}

}  // namespace talus::service
