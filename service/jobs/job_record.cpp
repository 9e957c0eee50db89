#include "jobs/job_record.hpp"

#include "base/digest.hpp"
#include "base/json.hpp"
#include "jobs/config.hpp"
#include "study/run_key.hpp"
#include "support/files.hpp"

namespace talus::service {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_record_bytes = std::size_t{1} << 28;

JobRecord from_json(const Json& json) {
  JobRecord record{.job = {.id = json.at("id"), .process = json.at("process"), .subject = json.at("subject")},
                   .created = json.at("created_ms"),
                   .document = json.at("case")};
  NewJob& job = record.job;
  job.title = json.at("title");
  job.inputs = dump(json.at("inputs"));
  job.seed = json.at("seed");
  job.planned = json.at("realizations");
  job.replicates = json.at("noise_floor_replicates");
  job.max_failed_share = json.at("max_failed_share");
  job.may_stop_early = json.at("may_stop_early");
  job.case_hash = json.at("case_hash");
  job.particles = json.at("particles");
  job.steps = json.at("steps");
  if (!is_random_hex(job.id, DataDirectory::id_bytes)) throw IoError("the id of its job is none");
  return record;
}

}  // namespace

fs::path job_record_path(const fs::path& directory) { return directory / "job.json"; }

void write_job_record(const fs::path& directory, const NewJob& job, Milliseconds created) {
  const Json json = {{"program", "talusd"},
                     {"id", job.id},
                     {"process", job.process},
                     {"subject", job.subject},
                     {"title", job.title},
                     {"inputs", Json::parse(job.inputs)},
                     {"seed", job.seed},
                     {"realizations", job.planned},
                     {"noise_floor_replicates", job.replicates},
                     {"max_failed_share", job.max_failed_share},
                     {"may_stop_early", job.may_stop_early},
                     {"case_hash", job.case_hash},
                     {"particles", job.particles},
                     {"steps", job.steps},
                     {"created_ms", created},
                     {"case", read_json(StudyPaths{directory}.resolved_case(), max_record_bytes)}};
  write_file_atomically(job_record_path(directory), with_checksum(json));
}

std::optional<JobRecord> find_job_record(const fs::path& directory) {
  const fs::path path = job_record_path(directory);
  if (!fs::exists(path)) return std::nullopt;
  return read_json(path, max_record_bytes, "a job record of talusd", from_json);
}

}  // namespace talus::service
