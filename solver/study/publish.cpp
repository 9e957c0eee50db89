#include "study/publish.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "support/csv.hpp"
#include "support/files.hpp"
#include "support/output_directory.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_case_bytes = std::size_t{1} << 30;
constexpr std::size_t max_csv_bytes = std::size_t{1} << 30;
constexpr std::size_t numbers = measure_table.size() + covariate_table.size();
constexpr std::size_t columns = 2 + numbers + 2;  ///< index and status; digest and reason
constexpr const char* of_realizations = "index";  ///< the head of the first column
constexpr const char* of_replicates = "replicate";

std::string csv_header(const std::string& index_name) {
  std::string line = index_name + ",status";
  const Record any;
  visit_numbers(any, [&](const char* key, const char*, auto) { line += std::string(",") + key; });
  return line + ",digest,reason\n";
}

/// Reads the number of a field. @param fail  called with what is wrong with it
template <class Number, class Fail>
void read_number(const std::string& field, Number& value, const Fail& fail) {
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc() || end != field.data() + field.size() || !std::isfinite(static_cast<double>(value)))
    fail(in_quotes(field) + " is not a number");
}

Record record(const std::vector<std::string>& fields, const std::string& place) {
  const auto fail = [&](const std::string& why) { throw IoError(place + " " + why); };
  if (fields.size() != columns)
    fail("has " + std::to_string(fields.size()) + " fields instead of " + std::to_string(columns));
  std::size_t at = 0;
  const auto fail_at = [&](const std::string& why) { fail("field " + std::to_string(at + 1) + ": " + why); };
  Record r;
  read_number(fields[0], r.index, fail_at);
  r.done = fields[1] == "done";
  if (!r.done && fields[1] != "failed") fail("has the status \"" + fields[1] + "\", which is neither done nor failed");
  r.reason = fields.back();
  if (!r.done) return r;
  at = 2;
  visit_numbers(r, [&](const char* key, const char*, auto& value) {
    if (fields[at].empty() && find_measure(key))  // the run was recorded before the measure existed
      value = std::numeric_limits<std::remove_reference_t<decltype(value)>>::quiet_NaN();
    else
      read_number(fields[at], value, fail_at);
    ++at;
  });
  r.digest = fields[at];
  return r;
}

/// Merges `more` into `all` (both in order of index), in linear time.
/// @param place  for messages: where `more` comes from
void join(std::vector<Record>& all, const std::vector<Record>& more, const std::string& what, const std::string& place,
          std::vector<Fault>& faults) {
  const auto middle = all.insert(all.end(), more.begin(), more.end());
  std::inplace_merge(all.begin(), middle, all.end(),
                     [](const Record& a, const Record& b) { return a.index < b.index; });
  std::vector<Record> joined;
  for (Record& r : all) {
    if (joined.empty() || joined.back().index != r.index)
      joined.push_back(std::move(r));
    else if (joined.back().done && r.done && joined.back().digest != r.digest)
      faults.push_back({"", what + " " + std::to_string(r.index) + " has two results: the digest is " +
                                joined.back().digest + " in an earlier directory and " + r.digest + " in " + place});
    else if (r.done && !joined.back().done)
      joined.back() = std::move(r);  // the same draw: the failure was that of a machine
  }
  all = std::move(joined);
}

void compare(const Plan& a, const Plan& b, const fs::path& first, const fs::path& other, std::vector<Fault>& faults) {
  const auto differ = [&](const std::string& what, const std::string& has, const std::string& wants) {
    if (has != wants)
      faults.push_back({"", other.string() + " cannot be merged with " + first.string() + ": the " + what + " is " +
                                wants + " there, not " + has});
  };
  const bool hypercube = a.study.sampling == Sampling::latin_hypercube;
  differ("case hash", a.of.hash, b.of.hash);
  differ("seed", std::to_string(a.seed), std::to_string(b.seed));
  differ("version of Talus", a.version, b.version);
  if (hypercube)
    differ("size of the Latin hypercube", std::to_string(a.study.realizations), std::to_string(b.study.realizations));
}

}  // namespace

std::string csv_line(const Record& record) {
  std::string line = std::to_string(record.index) + (record.done ? ",done" : ",failed");
  if (!record.done) return line + std::string(numbers + 2, ',') + csv_quoted(record.reason) + '\n';
  visit_numbers(record, [&](const char*, const char*, auto value) {
    line += ',';
    if (!std::isnan(static_cast<double>(value))) line += to_text(value);
  });
  return line + ',' + record.digest + ",\n";
}

std::vector<Record> read_csv(const fs::path& path, const std::string& index_name) {
  const std::string text = read_file(path, max_csv_bytes);
  CsvRows rows(text);
  if (!rows.next()) throw IoError(path.string() + " is empty");
  const auto place = [&] { return path.string() + ":" + std::to_string(rows.line()); };
  const std::string header = csv_header(index_name);
  if (std::string(rows.text()) + "\n" != header)
    throw IoError(place() + " is not the header of a table of Talus: expected " + header.substr(0, header.size() - 1));
  std::vector<Record> records;
  while (rows.next()) {
    records.push_back(record(rows.fields(), place()));
    if (records.size() > 1 && records.back().index <= records[records.size() - 2].index)
      throw IoError(place() + " has the " + index_name + " " + std::to_string(records.back().index) +
                    " out of order, or twice");
  }
  return records;
}

StudySummary publish(const StudyPaths& paths, const Plan& plan, const RecordSource& runs, const RecordSource& floor) {
  StudySummary summary(plan);
  AtomicFile realizations(paths.realizations()), noise_floor(paths.noise_floor());
  realizations.write(csv_header(of_realizations));
  runs([&](const Record& r) {
    if (summary.add(r)) realizations.write(csv_line(r));
  });
  noise_floor.write(csv_header(of_replicates));
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
  Tables tables{.plan = std::move(*plan), .runs = read_csv(paths.realizations(), of_realizations), .floor = {}};
  if (fs::exists(paths.noise_floor())) tables.floor = read_csv(paths.noise_floor(), of_replicates);
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
  OutputDirectory claimed(out, OutputKind::study, tables.plan.of, true);
  write_file_atomically(StudyPaths{out}.resolved_case(), resolved_case);
  write_plan(out, tables.plan);
  write_tables(StudyPaths{out}, tables.plan, tables.runs, tables.floor);
  claimed.mark_finished();
}

}  // namespace talus
