// talusd: the queue, its workers and its HTTP side in one process.

#include <malloc.h>
#include <pthread.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <exception>
#include <iostream>
#include <new>
#include <system_error>
#include <thread>

#include "base/json.hpp"
#include "http/server.hpp"
#include "http/service.hpp"
#include "jobs/backup.hpp"
#include "jobs/orphans.hpp"
#include "jobs/reserve.hpp"
#include "options.hpp"
#include "support/files.hpp"
#include "support/standard_output.hpp"

namespace {

using namespace talus;
using namespace talus::service;

/// Blocks the signals for talusd in every thread, so that main can wait for them.
sigset_t hold_signals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&set, number);
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);
  return set;
}

/// Many threads that do little: small stacks, and few of the pools in which glibc reserves 64 MiB each. Large blocks
/// (bodies, answers) go back to the system at once.
void spare_address_space() {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  pthread_attr_t small;
  if (pthread_attr_init(&small) != 0) return;
  pthread_attr_setstacksize(&small, std::size_t{2} << 20);
  pthread_setattr_default_np(&small);
  pthread_attr_destroy(&small);
  mallopt(M_ARENA_MAX, 2);
  mallopt(M_MMAP_THRESHOLD, 256 << 10);
#endif
}

/// Allows as many descriptors as possible, for threads, workers and clients.
void raise_file_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, 65536);
  setrlimit(RLIMIT_NOFILE, &limit);
}

/// Takes a lock, which a killed process may hold a moment longer.
/// @param inherited  workers hold it, too
/// @throws IoError with the text `otherwise` where another process still holds it after `patience`
FileDescriptor wait_for_lock(const std::filesystem::path& path, bool inherited, std::chrono::seconds patience,
                             const std::string& otherwise) {
  const auto end = std::chrono::steady_clock::now() + patience;
  for (;;) {
    TriedLock lock = try_lock(path, inherited);
    if (!lock.supported) throw IoError(path.string() + ": the file system has no locks; choose another --data");
    if (lock.file) return std::move(lock.file);
    if (std::chrono::steady_clock::now() > end) throw IoError(otherwise);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

/// The data directory, made if need be, for this process alone.
class ClaimedData {
 public:
  /// @throws IoError where another talusd or its workers use it
  explicit ClaimedData(const DataDirectory& data) {
    for (const auto& directory : {data.root, data.jobs(), data.scratch()})
      std::filesystem::create_directories(directory);
    lock_ = wait_for_lock(data.lock(), false, std::chrono::seconds(1), "another talusd is using " + data.root.string());
    // The workers of a killed talusd end a moment after it; until then they may still write into the data directory.
    workers_lock_ =
        wait_for_lock(data.workers_lock(), true, std::chrono::seconds(10),
                      "workers of an earlier talusd still run in " + data.root.string() + "; stop them first");
  }

 private:
  FileDescriptor lock_, workers_lock_;
};

std::unique_ptr<talus::service::Store> open_store(const Config& config) {
  const DataDirectory data{config.data};
  const auto lease = std::chrono::duration_cast<std::chrono::milliseconds>(config.lease).count();
  const auto open = [&] {
    return std::make_unique<talus::service::Store>(data.database(), data.jobs(), system_now, lease);
  };
  return with_reserve(data, open);
}

int adopt(const Config& config) {
  const DataDirectory data{config.data};
  const ClaimedData claimed(data);
  const auto opened = open_store(config);
  talus::service::Store& store = *opened;
  put_orphans_aside(data, store.job_ids());
  for (const Adoption& of : adopt_orphans(data, store))
    std::cout << (of.adopted ? "adopted " : "left ") << of.name << ": " << of.message << "\n";
  return static_cast<int>(Exit::ok);
}

int back_up_data(const Config& config, const std::filesystem::path& target) {
  const BackupReport report = back_up({config.data}, target);
  for (const std::string& id : report.missing) std::cerr << "talusd: job " << id << " has no directory\n";
  std::cout << target.string() << ": " << report.jobs << " jobs, " << report.files << " files, " << (report.bytes >> 20)
            << " MiB\n";
  return static_cast<int>(Exit::ok);
}

void reload(Tokens& tokens) {
  if (!tokens.wanted()) return log_info("hangup", {{"why", "there is no tokens file to read again"}});
  try {
    tokens.reload();
    log_info("tokens_reloaded");
  } catch (const std::exception& e) {
    log_error("tokens_not_reloaded", {{"why", e.what()}});
  }
}

/// @return SIGINT or SIGTERM; SIGHUP reloads the tokens
int wait_for_stop(const sigset_t& signals, Tokens& tokens) {
  for (int number = 0;;) {
    sigwait(&signals, &number);
    if (number != SIGHUP) return number;
    reload(tokens);
  }
}

int serve(Config config) {
  const sigset_t signals = hold_signals();
  spare_address_space();
  raise_file_limit();
  const auto known = config.tokens.empty() ? std::make_unique<Tokens>() : std::make_unique<Tokens>(config.tokens);
  Tokens& tokens = *known;
  const DataDirectory data{config.data};
  const ClaimedData claimed(data);
  const auto opened = open_store(config);
  talus::service::Store& store = *opened;
  Scheduler scheduler(config, store);
  Jobs jobs(config, store, scheduler);
  std::atomic<bool> stopping{false};
  Service service{.config = config, .store = store, .jobs = jobs, .scheduler = scheduler, .stopping = [&] {
                    return stopping.load();
                  }};
  Routes routes;
  for (const Routes& group :
       {discovery_routes(), job_routes(), realization_routes(), event_routes(), operation_routes(), umbridge_routes()})
    routes.insert(routes.end(), group.begin(), group.end());
  const auto server =
      make_server(config, [&](Incoming request) { return admit(std::move(request), routes, service, tokens); });
  config.port = server->bind(config.address, config.port);
  if (config.port == 0)
    throw IoError("cannot listen on " + config.address +
                  ": the port is in use, or the address does not belong to this host");
  scheduler.start();
  std::thread http([&] { server->serve(); });
  const bool is_v6 = config.address.find(':') != std::string::npos;
  const std::string url =
      "http://" + (is_v6 ? "[" + config.address + "]" : config.address) + ":" + std::to_string(config.port);
  std::cout << "talusd " << TALUS_VERSION << " listens on " << url << std::endl;
  log_info("started",
           {{"url", url}, {"data", data.root.string()}, {"workers", config.workers}, {"threads", config.threads}});

  const int number = wait_for_stop(signals, tokens);
  log_info("stopping", {{"signal", number}});
  stopping = true;
  jobs.stop();
  scheduler.changes().notify();
  scheduler.drain();
  server->stop();
  http.join();
  log_info("stopped");
  std::cout.clear();  // a daemon whose standard output is closed has done its work all the same
  std::clearerr(stdout);
  return static_cast<int>(Exit::ok);
}

/// The program, but for the check of its output. @return the exit code
int run_program(int argc, char** argv) {
  const Options options = read_options(argc, argv);
  if (options.exit) return *options.exit;
  ::umask(027);  // the data of jobs are not readable for every user of this machine
  try {
    if (!options.new_token.empty()) {
      const std::string expires = options.new_token.size() > 2 ? options.new_token[2] : "";
      const auto [token, line] = new_token(options.new_token[0], options.new_token[1], expires);
      std::cout << "token: " << token << "\nline for the tokens file: " << line << "\n";
      return static_cast<int>(Exit::ok);
    }
    if (options.adopt) return adopt(options.config);
    if (!options.backup.empty()) return back_up_data(options.config, options.backup);
    return serve(options.config);
  } catch (const TokensError& e) {
    std::cerr << "talusd: " << e.what() << "\n";
    return static_cast<int>(Exit::usage);
  } catch (const std::bad_alloc&) {
    std::cerr << "talusd: the memory does not suffice to start; raise its limit (ulimit -v, MemoryMax)\n";
    return static_cast<int>(Exit::io);
  } catch (const std::system_error& e) {
    const bool threads = e.code() == std::errc::resource_unavailable_try_again;
    std::cerr
        << "talusd: "
        << (threads
                ? "no thread can be started; raise the limits of processes and memory (ulimit -u, TasksMax, ulimit -v)"
                : e.what())
        << "\n";
    return static_cast<int>(Exit::io);
  } catch (const std::exception& e) {
    std::cerr << "talusd: " << e.what() << "\n";
    const bool io = dynamic_cast<const IoError*>(&e) || dynamic_cast<const StorageError*>(&e) ||
                    dynamic_cast<const std::filesystem::filesystem_error*>(&e);
    return static_cast<int>(io ? Exit::io : Exit::internal);
  }
}

}  // namespace

int main(int argc, char** argv) { return checked_output(run_program(argc, argv), "talusd"); }
