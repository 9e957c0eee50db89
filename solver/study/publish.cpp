#include "study/publish.hpp"

#include <algorithm>

#include "study/csv.hpp"
#include "support/files.hpp"
#include "support/output_directory.hpp"

namespace talus {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_case_bytes = std::size_t{1} << 30;
constexpr const char* index_name = "index";
constexpr const char* replicate_name = "replicate";

/// Adds `more` to `all` (both in order of index).
/// @param place  for messages: where `more` comes from
void join(std::vector<Record>& all, const std::vector<Record>& more, const std::string& what, const std::string& place,
          std::vector<Fault>& faults) {
  for (const Record& r : more) {
    const auto at = std::lower_bound(all.begin(), all.end(), r.index,
                                     [](const Record& a, std::int64_t index) { return a.index < index; });
    if (at == all.end() || at->index != r.index) {
      all.insert(at, r);
    } else if (at->done && r.done && at->digest != r.digest) {
      faults.push_back({"", what + " " + std::to_string(r.index) + " has two results: the digest is " + at->digest +
                                " in an earlier directory and " + r.digest + " in " + place});
    } else if (r.done && !at->done) {
      *at = r;  // the same draw: where it failed, the machine was to blame
    }
  }
}

void compare(const Plan& a, const Plan& b, const fs::path& first, const fs::path& other, std::vector<Fault>& faults) {
  const auto differ = [&](const std::string& what, const std::string& has, const std::string& wants) {
    if (has != wants)
      faults.push_back({"", other.string() + " cannot be merged with " + first.string() + ": the " + what + " is " +
                                wants + " there, not " + has});
  };
  const bool hypercube = a.study.sampling == Sampling::latin_hypercube;
  differ("case hash", a.case_hash, b.case_hash);
  differ("seed", std::to_string(a.seed), std::to_string(b.seed));
  differ("version of Talus", a.version, b.version);
  if (hypercube)
    differ("size of the Latin hypercube", std::to_string(a.study.realizations), std::to_string(b.study.realizations));
}

}  // namespace

StudySummary publish(const StudyPaths& paths, const Plan& plan, const RecordSource& runs, const RecordSource& floor) {
  StudySummary summary(plan);
  AtomicFile realizations(paths.realizations()), noise_floor(paths.noise_floor());
  realizations.write(csv_header(index_name));
  runs([&](const Record& r) {
    if (summary.add(r)) realizations.write(csv_line(r));
  });
  noise_floor.write(csv_header(replicate_name));
  floor([&](const Record& r) {
    summary.add_replicate(r);
    noise_floor.write(csv_line(r));
  });
  realizations.commit();
  noise_floor.commit();
  write_file_atomically(paths.summary(), summary.json().dump(2) + "\n");
  return summary;
}

void write_tables(const StudyPaths& paths, const Plan& plan, const std::vector<Record>& runs,
                  const std::vector<Record>& floor) {
  const auto source = [](const std::vector<Record>& records) {
    return [&records](const RecordSink& take) { std::for_each(records.begin(), records.end(), take); };
  };
  publish(paths, plan, source(runs), source(floor));
}

Tables read_tables(const fs::path& directory) {
  std::optional<Plan> plan = find_plan(directory);
  if (!plan) throw IoError(directory.string() + " does not hold a study: there is no plan.json");
  const StudyPaths paths{directory};
  Tables tables{.plan = std::move(*plan), .runs = read_csv(paths.realizations(), index_name), .floor = {}};
  if (fs::exists(paths.noise_floor())) tables.floor = read_csv(paths.noise_floor(), replicate_name);
  const std::int64_t planned = tables.plan.study.realizations;
  if (!tables.runs.empty() && (tables.runs.front().index < 0 || tables.runs.back().index >= planned))
    throw IoError(paths.realizations().string() + " holds realizations beyond the " + std::to_string(planned) +
                  " of the plan");
  return tables;
}

Tables merge(const std::vector<fs::path>& directories) {
  Tables all = read_tables(directories.front());
  std::vector<Fault> faults;
  for (std::size_t i = 1; i < directories.size(); ++i) {
    const Tables more = read_tables(directories[i]);
    compare(all.plan, more.plan, directories.front(), directories[i], faults);
    join(all.runs, more.runs, "realization", directories[i].string(), faults);
    join(all.floor, more.floor, "noise-floor replicate", directories[i].string(), faults);
    all.plan.study.realizations = std::max(all.plan.study.realizations, more.plan.study.realizations);
    all.plan.study.noise_floor_replicates =
        std::max(all.plan.study.noise_floor_replicates, more.plan.study.noise_floor_replicates);
  }
  if (!faults.empty()) throw ConfigError(std::move(faults));
  return all;
}

void write_merged(const fs::path& out, const Tables& tables, const fs::path& origin) {
  if (fs::exists(StudyPaths{out}.runs()))
    throw IoError("cannot write into " + out.string() +
                  ": it holds a study with runs of its own; choose another directory");
  const std::string resolved_case =
      read_file(StudyPaths{origin}.resolved_case(), max_case_bytes);  // before anything is written
  OutputDirectory claimed(out, OutputKind::study, tables.plan.case_hash, true);
  write_file_atomically(StudyPaths{out}.resolved_case(), resolved_case);
  write_plan(out, tables.plan);
  write_tables(StudyPaths{out}, tables.plan, tables.runs, tables.floor);
  claimed.mark_finished();
}

}  // namespace talus
