// talusd: the queue, its workers and its HTTP side in one process.

#include <malloc.h>
#include <pthread.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <exception>
#include <iostream>
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

/// Blocks the signals that stop talusd in every thread, so that main can wait for them.
sigset_t hold_stop_signals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&set, number);
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);
  return set;
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

/// Memory of large bodies and documents goes back to the system when it is freed. Without this, the allocator keeps it
/// in an arena of each thread.
void return_freed_memory() {
  mallopt(M_ARENA_MAX, 4);
  mallopt(M_MMAP_THRESHOLD, 1 << 20);
  mallopt(M_TRIM_THRESHOLD, 8 << 20);
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

int serve(Config config) {
  const sigset_t stop_signals = hold_stop_signals();
  raise_file_limit();
  return_freed_memory();
  const Tokens tokens = config.tokens.empty() ? Tokens() : Tokens(config.tokens);
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
  const auto server = make_server(config, !tokens.wanted() && config.public_url.empty(), [&](Incoming request) {
    return answer(std::move(request), routes, service, tokens);
  });
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

  int number = 0;
  sigwait(&stop_signals, &number);
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
      const auto [token, line] = new_token(options.new_token[0], options.new_token[1]);
      std::cout << "token: " << token << "\nline for the tokens file: " << line << "\n";
      return static_cast<int>(Exit::ok);
    }
    if (options.adopt) return adopt(options.config);
    if (!options.backup.empty()) return back_up_data(options.config, options.backup);
    return serve(options.config);
  } catch (const std::exception& e) {
    std::cerr << "talusd: " << e.what() << "\n";
    const bool io = dynamic_cast<const IoError*>(&e) || dynamic_cast<const StorageError*>(&e) ||
                    dynamic_cast<const std::filesystem::filesystem_error*>(&e);
    return static_cast<int>(io ? Exit::io : Exit::internal);
  }
}

}  // namespace

int main(int argc, char** argv) { return checked_output(run_program(argc, argv), "talusd"); }
