// The fields and profiles of runs, which Jobs makes for requests.

#include <algorithm>

#include "base/json.hpp"
#include "jobs/jobs.hpp"
#include "jobs/repair.hpp"
#include "support/csv.hpp"
#include "support/digest.hpp"
#include "support/files.hpp"
#include "support/text.hpp"

namespace talus::service {
namespace {

namespace fs = std::filesystem;
using std::chrono::seconds;

constexpr std::size_t profiles_kept = 16;  ///< of a job
constexpr std::size_t max_picture_bytes = std::size_t{256} << 20;
constexpr seconds picture_patience{60};  ///< of a request for a field or a profile
constexpr seconds profile_limit{3600};

/// Removes all but the newest requested profiles; those that the study keeps itself stay.
void prune(const fs::path& directory) {
  std::vector<std::pair<fs::file_time_type, fs::path>> files;
  for (const auto& entry : fs::directory_iterator(directory))
    if (run_of_work_name(entry.path().stem().string())) files.emplace_back(entry.last_write_time(), entry.path());
  std::sort(files.rbegin(), files.rend());
  std::error_code ignored;
  for (std::size_t i = profiles_kept; i < files.size(); ++i) fs::remove(files[i].second, ignored);
}

/// The last line of a kept profile.
std::string checksum_line(const std::string& text) { return hex_digits(fnv1a64(text)) + "\n"; }

/// The text of a kept profile; nothing where there is none, or it is damaged.
std::optional<std::string> find_kept(const fs::path& file) {
  std::optional<std::string> text = find_file(file, max_picture_bytes);
  const std::size_t length = checksum_line("").size();
  if (!text || text->size() < length) return std::nullopt;
  const std::string line = text->substr(text->size() - length);
  text->resize(text->size() - length);
  if (line != checksum_line(*text)) return std::nullopt;
  return text;
}

}  // namespace

void Jobs::check_made(const CommandOutput& output, const std::string& what) {
  if (output.ok()) return;
  log_failure(output);
  throw Refusal(reason::internal, what + " could not be made");
}

std::string Jobs::field(const Job& job, std::int64_t index, bool svg, const Caller& caller) {
  const std::string name = job.id + "/" + std::to_string(index) + (svg ? ".svg" : ".json");
  return fields_.get(name, caller, picture_patience, [this, job, index, svg](const Productions::Abandoned& abandoned) {
    return make_field(job, index, svg, abandoned);
  });
}

std::string Jobs::make_field(const Job& job, std::int64_t index, bool svg, const Productions::Abandoned& abandoned) {
  const TemporaryDirectory scratch = scratch_directory();
  const fs::path file = scratch / (svg ? "field.svg" : "field.csv");
  const CommandOutput output =
      run(short_command(config_, {"field", checked_case(data_, job), "--realization", std::to_string(index), "--seed",
                                  std::to_string(job.seed), "--out", file, "--json"}),
          command_limit, abandoned);
  check_made(output, "the field");
  const std::string text = read_file(file, max_picture_bytes);
  if (svg) return text;
  Json json = Json::parse(output.out);
  CsvRows rows(text);
  rows.next();  // the header: x_m, y_m, friction_angle_deg, tan_phi
  for (const char* key : {"x_m", "y_m", "particle_friction_angle_deg"}) json[key] = Json::array();
  while (rows.next()) {
    const std::vector<std::string> fields = rows.fields();
    json["x_m"].push_back(to_number(fields.at(0)).value());
    json["y_m"].push_back(to_number(fields.at(1)).value());
    json["particle_friction_angle_deg"].push_back(to_number(fields.at(2)).value());
  }
  return dump(json);
}

std::string Jobs::profile(const Job& job, std::int64_t index, bool svg, const Caller& caller) {
  const fs::path kept = StudyPaths{data_.job(job.id)}.profiles() / (std::to_string(index) + (svg ? ".svg" : ".json"));
  if (auto text = find_kept(kept)) return *text;
  return runs_.get(kept.string(), caller, picture_patience,
                   [this, job, index, kept](const Productions::Abandoned& abandoned) {
                     if (auto text = find_kept(kept)) return *text;  // made between the two looks
                     return make_profile(job, index, kept, abandoned);
                   });
}

std::string Jobs::make_profile(const Job& job, std::int64_t index, const fs::path& kept,
                               const Productions::Abandoned& abandoned) {
  const fs::path case_file = checked_case(data_, job);
  const TemporaryDirectory scratch = scratch_directory();
  const fs::path out = scratch / "run", file = scratch / ("profile" + kept.extension().string());
  const std::string seed = std::to_string(job.seed);
  check_made(run(single_run(config_, {case_file, "--realization", std::to_string(index), "--seed", seed, "--out", out}),
                 profile_limit, abandoned),
             "the profile");
  check_made(run(short_command(config_, {"profile", out, "--out", file}), command_limit, abandoned), "the profile");
  const std::string text = read_file(file, max_picture_bytes);
  fs::create_directories(kept.parent_path());
  write_file_atomically(kept, text + checksum_line(text));
  prune(kept.parent_path());
  return text;
}

}  // namespace talus::service
