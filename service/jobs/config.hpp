#pragma once
// The settings of talusd, and the layout of its data directory.

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "executor/slurm_config.hpp"

namespace talus::service {

/// Limits of a job; a rejected request reports limit and value.
struct Quotas {
  double particles = 2e6;  ///< soil and wall
  double steps = 1e7;      ///< of one realization
  std::int64_t realizations = 100'000;
  double core_hours = 10'000;                         ///< estimated for the whole job
  std::int64_t open_jobs = 1000;                      ///< accepted and running, of all subjects
  std::int64_t open_jobs_of_one = 200;                ///< of one subject
  std::uint64_t disk_bytes = std::uint64_t{1} << 30;  ///< that must stay free
  std::uint64_t echo_bytes = std::uint64_t{1} << 30;  ///< of the inputs of echo jobs that are not dismissed, in all
  std::uint64_t echo_bytes_of_one = std::uint64_t{512} << 20;  ///< of one subject
};

struct Config {
  std::filesystem::path data;     ///< root of DataDirectory
  std::filesystem::path program;  ///< talus
  std::filesystem::path models;   ///< cases served over UM-Bridge; empty: none
  std::filesystem::path tokens;   ///< empty: no tokens, loopback only
  std::string address = "127.0.0.1";
  int port = 8080;                             ///< 0: any free one
  std::string public_url;                      ///< of absolute links; empty: by the name in the Host header
  std::optional<executor::SlurmConfig> slurm;  ///< unset: runs are processes of this machine
  int workers = 1;                             ///< runs at a time on this machine
  int threads = 1;                             ///< of each run
  int attempts = 5;                            ///< crashes of a run before it counts as failed
  int niceness = 5;                            ///< of runs
  std::chrono::seconds lease{30};
  std::chrono::seconds time_limit{6 * 3600};  ///< of one run
  std::chrono::seconds grace{30};             ///< for workers to checkpoint when talusd is asked to stop
  std::optional<std::uint64_t> memory_bytes;  ///< address space of one run; unset: from its size; 0: no limit
  std::uint64_t file_bytes = std::uint64_t{4} << 30;
  std::vector<std::string> hosts;                     ///< further names under which the service is addressed
  int connections = 1024;                             ///< at a time
  int connections_each = 256;                         ///< of them, from one address
  int http_threads = 16;                              ///< handlers of ordinary requests at a time
  std::size_t body_bytes = std::size_t{4} << 20;      ///< of one request
  std::size_t traffic_bytes = std::size_t{64} << 20;  ///< bodies and answers in memory, of all requests
  int streams = 64;                                   ///< event streams, long polls and waits at a time
  int streams_each = 32;                              ///< of them, of one subject, where there are tokens
  std::chrono::milliseconds request_limit{15'000};    ///< for a client to send the head of its request
  Quotas quotas;
};

/// With less free disk space no run starts, and a failed write is attributed to the full disk.
inline constexpr std::uint64_t least_disk_bytes = std::uint64_t{16} << 20;

/// DATA, the data directory.
struct DataDirectory {
  std::filesystem::path root;

  std::filesystem::path database() const { return root / "queue.sqlite"; }
  std::filesystem::path lock() const { return root / "talusd.lock"; }
  std::filesystem::path workers_lock() const { return root / "workers.lock"; }
  std::filesystem::path jobs() const { return root / "jobs"; }
  std::filesystem::path scratch() const { return root / "scratch"; }  ///< emptied at start
  std::filesystem::path slurm() const { return root / "slurm"; }
  std::filesystem::path reserve() const { return root / "reserve"; }  ///< disk space for deleting jobs
  std::filesystem::path orphans() const { return root / "orphans"; }  ///< directories that the queue did not know
  /// The directory of one job: that of a `talus study`, so that every subcommand of talus reads it.
  std::filesystem::path job(const std::string& id) const { return jobs() / id; }
  /// The directory of a job until its submission is complete; removed at start.
  std::filesystem::path unfinished(const std::string& id) const {
    return jobs() / (std::string(unfinished_prefix) + id);
  }
  static constexpr std::string_view unfinished_prefix = "new-";
  static constexpr std::size_t id_bytes = 16;      ///< of a job's random id, which has two hexadecimal digits a byte
  static constexpr std::size_t scratch_bytes = 8;  ///< of the random name of a directory in scratch()
};

}  // namespace talus::service
