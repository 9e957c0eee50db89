#include "study/publish.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>

#include "support/csv.hpp"
#include "support/digest.hpp"
#include "support/files.hpp"
#include "support/json.hpp"
#include "support/output_directory.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_case_bytes = std::size_t{1} << 30;
constexpr std::size_t max_csv_bytes = std::size_t{1} << 30;
constexpr const char* of_realizations = "index";  ///< the head of the first column
constexpr const char* of_replicates = "replicate";
constexpr const char* checksum_column = "checksum";  ///< the last one

/// The columns of a table, in order. Those of version 0.1.0 stand first, later ones after them.
std::vector<std::string> column_names(const std::string& index_name) {
  std::vector<std::string> names{index_name, "status"}, later{"verdict", "verdict_reasons", "lower_bounds"};
  const Record any;
  visit_numbers(any, [&](const char* key, const char*, auto) { (is_later(key) ? later : names).emplace_back(key); });
  names.insert(names.end(), {"digest", "reason"});
  names.insert(names.end(), later.begin(), later.end());
  names.emplace_back(checksum_column);
  return names;
}

/// The columns of a target, in order.
std::vector<std::string> target_columns(const TargetName& target) {
  std::vector<std::string> names{target.name + "." + arrives_key, target.name + "." + open_key};
  for (const TargetNumber& number : target_numbers)
    if (has_number(target.kind, number)) names.push_back(target.name + "." + number.key);
  return names;
}

std::string csv_header(const std::string& index_name, const std::vector<TargetName>& targets) {
  std::vector<std::string> names = column_names(index_name);
  for (const TargetName& target : targets)
    for (const std::string& name : target_columns(target)) names.insert(names.end() - 1, name);
  std::string line;
  for (const std::string& name : names) line += (line.empty() ? "" : ",") + name;
  return line + "\n";
}

/// Whether a column belongs to a target: "house.peak_depth_m".
bool is_of_target(const std::string& column) {
  const std::size_t dot = column.rfind('.');
  if (dot == std::string::npos || dot == 0) return false;
  const std::string key = column.substr(dot + 1);
  return key == arrives_key || key == open_key || find_target_number(key) != nullptr;
}

/// Where the columns of a table stand, from its header. A table of an earlier version lacks those added later.
class Columns {
 public:
  /// @param fail  called with what is wrong with the header
  template <class Fail>
  Columns(const std::vector<std::string>& header, const std::string& index_name, const Fail& fail) : header_(header) {
    const std::vector<std::string> known = column_names(index_name);
    for (std::size_t i = 0; i < header.size(); ++i) {
      if (header[i].ends_with(std::string(".") + arrives_key))
        targets_.push_back({header[i].substr(0, header[i].rfind('.')), TargetKind::point});
      else if (std::ranges::find(known, header[i]) == known.end() && !is_of_target(header[i]))
        fail("the column " + in_quotes(header[i]) + " is unknown" + suggestion(header[i], known));
      if (!at_.emplace(header[i], i).second) fail("the column " + in_quotes(header[i]) + " stands there twice");
    }
    for (const std::string& name : known)
      if (!at_.contains(name) && !may_be_missing(name) && !name.starts_with("verdict") && name != "lower_bounds" &&
          name != checksum_column)
        fail("the column " + in_quotes(name) + " is missing");
    index_ = at_.at(index_name);
    for (TargetName& target : targets_) {
      const TargetName loaded{target.name, TargetKind::structure};
      if (at_.contains(target_columns(loaded).back())) target.kind = TargetKind::structure;
      for (const std::string& name : target_columns(target))
        if (!at_.contains(name)) fail("the column " + in_quotes(name) + " is missing");
    }
  }

  std::size_t size() const { return header_.size(); }
  const std::string& name(std::size_t at) const { return header_[at]; }
  std::size_t index() const { return index_; }
  /// Of the columns "NAME.arrives", in their order; a stretch looks like a point.
  const std::vector<TargetName>& targets() const { return targets_; }
  /// The place of a column; unset where the table lacks it.
  std::optional<std::size_t> find(std::string_view name) const {
    const auto found = at_.find(name);
    return found == at_.end() ? std::nullopt : std::optional(found->second);
  }

 private:
  std::vector<std::string> header_;
  std::vector<TargetName> targets_;
  std::size_t index_ = 0;
  std::map<std::string, std::size_t, std::less<>> at_;
};

/// Reads the number of a field. @param fail  called with what is wrong with it
template <class Number, class Fail>
void read_number(const std::string& field, Number& value, const Fail& fail) {
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc() || end != field.data() + field.size() || !std::isfinite(static_cast<double>(value)))
    return fail(in_quotes(field) + " is not a number");
  if (std::abs(static_cast<double>(value)) > largest_number)
    fail(field + " is out of range; allowed -1e12 to 1e12, beyond which no run has a number");
}

Record record(const std::vector<std::string>& fields, const Columns& columns, const std::string& place) {
  const auto fail = [&](const std::string& why) { throw IoError(place + " " + why); };
  if (fields.size() != columns.size())
    fail("has " + std::to_string(fields.size()) + " fields instead of " + std::to_string(columns.size()));
  const auto number = [&](std::size_t at, auto& value) {
    read_number(fields[at], value, [&](const std::string& why) {
      fail("field " + std::to_string(at + 1) + " (" + columns.name(at) + "): " + why);
    });
  };
  const auto text = [&](const char* name) {
    const std::optional<std::size_t> at = columns.find(name);
    return at ? fields[*at] : std::string();
  };
  Record r;
  number(columns.index(), r.index);
  if (r.index < 0 || r.index >= end_of_indices)
    fail("has the " + columns.name(columns.index()) + " " + std::to_string(r.index) + ", which no study has");
  const std::string status = text("status");
  if (status == "failed") return failed_record(r.index, text("reason"));
  if (status != "done") fail("has the status \"" + status + "\", which is neither done nor failed");
  r.done = true;
  visit_numbers(r, [&](const char* key, const char*, auto& value) {
    const std::optional<std::size_t> at = columns.find(key);
    if (may_be_missing(key) && (!at || fields[*at].empty()))  // the run was recorded before the number existed
      value = std::numeric_limits<std::remove_reference_t<decltype(value)>>::quiet_NaN();
    else
      number(*at, value);
  });
  const auto flag = [&](const std::string& name, bool& value) {
    const std::string cell = text(name.c_str());
    if (cell != "0" && cell != "1") fail(name + " is neither 0 nor 1");
    value = cell == "1";
  };
  for (const TargetName& of : columns.targets()) {
    TargetOutcome& target = r.targets.emplace_back(TargetOutcome{.of = of});
    flag(of.name + "." + arrives_key, target.arrives);
    flag(of.name + "." + open_key, target.open);
    for (const TargetNumber& of_target : target_numbers) {
      if (!has_number(of.kind, of_target)) continue;
      const std::size_t at = *columns.find(of.name + "." + of_target.key);
      if (!fields[at].empty() || !of_target.optional) number(at, target.*of_target.member);
    }
  }
  r.digest = text("digest");
  r.objections = text("verdict_reasons");
  r.lower_bounds = text("lower_bounds");
  const std::string verdict = text("verdict");
  const std::optional<Verdict> known = verdict_of(verdict.empty() ? word(Verdict::not_assessed) : verdict);
  if (!known) fail("has the unknown verdict \"" + verdict + "\"");
  r.verdict = *known;
  return r;
}

/// A line of a table with the hash of what stands before it as its last field.
std::string line_with_checksum(const Record& record, const std::vector<TargetName>& targets) {
  std::string line = csv_line(record, targets);
  line.pop_back();
  return line + ',' + hex_digits(fnv1a64(line)) + '\n';
}

/// @throws IoError where a line does not agree with its checksum
void check_line(std::string_view line, const std::string& place) {
  const std::size_t last = line.rfind(',');
  if (last == std::string_view::npos || line.substr(last + 1) != hex_digits(fnv1a64(line.substr(0, last))))
    throw IoError(place + " does not agree with its checksum: the file is damaged, or was edited");
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

std::string csv_line(const Record& record, const std::vector<TargetName>& targets) {
  std::string numbers, later, of_targets;
  for (const TargetOutcome& target : record.targets) {
    of_targets += std::string(target.arrives ? ",1" : ",0") + (target.open ? ",1" : ",0");
    for (const TargetNumber& number : target_numbers) {
      if (!has_number(target.of.kind, number)) continue;
      const double value = target.*number.member;
      of_targets += ',' + (std::isnan(value) ? "" : to_text(value));
    }
  }
  if (record.targets.empty())  // it failed
    for (const TargetName& target : targets) of_targets.append(target_columns(target).size(), ',');
  visit_numbers(record, [&](const char* key, const char*, auto value) {
    std::string& cells = is_later(key) ? later : numbers;
    cells += ',';
    if (record.done && !std::isnan(static_cast<double>(value))) cells += to_text(value);
  });
  const char* verdict = record.verdict == Verdict::not_assessed ? "" : word(record.verdict);
  return std::to_string(record.index) + (record.done ? ",done" : ",failed") + numbers + ',' + record.digest + ',' +
         csv_quoted(record.reason) + ',' + verdict + ',' + csv_quoted(record.objections) + ',' +
         csv_quoted(record.lower_bounds) + later + of_targets + '\n';
}

std::vector<Record> read_csv(const fs::path& path, const std::string& index_name) {
  const std::string text = read_file(path, max_csv_bytes);
  CsvRows rows(text);
  if (!rows.next()) throw IoError(path.string() + " is empty");
  const auto place = [&] { return path.string() + ":" + std::to_string(rows.line()); };
  const Columns columns(rows.fields(), index_name, [&](const std::string& why) {
    throw IoError(place() + " is not the header of a table of Talus: " + why);
  });
  const bool checked = columns.find(checksum_column).has_value();
  std::vector<Record> records;
  while (rows.next()) {
    if (checked) check_line(rows.text(), place());
    records.push_back(record(rows.fields(), columns, place()));
    if (records.size() > 1 && records.back().index <= records[records.size() - 2].index)
      throw IoError(place() + " has the " + index_name + " " + std::to_string(records.back().index) +
                    " out of order, or twice");
  }
  return records;
}

StudySummary publish(const StudyPaths& paths, const Plan& plan, const RecordSource& runs, const RecordSource& floor) {
  StudySummary summary(plan);
  AtomicFile realizations(paths.realizations()), noise_floor(paths.noise_floor());
  realizations.write(csv_header(of_realizations, plan.targets));
  runs([&](const Record& r) {
    if (summary.add(r)) realizations.write(line_with_checksum(r, plan.targets));
  });
  noise_floor.write(csv_header(of_replicates, plan.targets));
  floor([&](const Record& r) {
    summary.add_replicate(r);
    noise_floor.write(line_with_checksum(r, plan.targets));
  });
  realizations.commit();
  noise_floor.commit();
  write_file_atomically(paths.summary(), with_checksum(summary.json()));
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
