#pragma once
// The files of a study that others read, and the way back from its tables.

#include <filesystem>
#include <functional>
#include <vector>

#include "study/plan.hpp"
#include "study/record.hpp"
#include "study/run_key.hpp"
#include "study/summary.hpp"

namespace talus {

/// Reads realizations.csv or noise_floor.csv: RFC 4180, a header, then one line per record in order of index, with
/// numbers that read back exactly. `index_name` heads the first column ("index", "replicate"). Columns are found by
/// name; a table of an earlier version may lack those that came later: measures and other numbers are NaN then, and the
/// verdict is not_assessed. The last column, `checksum`, is the FNV-1a hash (64 bits) of the line before it.
/// @throws IoError naming file and line: a line that does not agree with its checksum, a column that is unknown,
/// missing or there twice, a wrong number of fields, not a number, indices out of order or twice
std::vector<Record> read_csv(const std::filesystem::path& path, const std::string& index_name);

/// The line of a record in these tables, without its checksum.
/// @param targets  of the study: columns that a failed run leaves empty
std::string csv_line(const Record& record, const std::vector<TargetName>& targets = {});

/// Takes a record.
using RecordSink = std::function<void(const Record&)>;
/// Gives the records of one kind to a sink, in order of index.
using RecordSource = std::function<void(const RecordSink&)>;

/// Writes realizations.csv, noise_floor.csv and study.json, each by rename; of a study that stopped early, the records
/// before the stop. Records pass one by one; memory: that of StudySummary.
/// @throws IoError
StudySummary publish(const StudyPaths& paths, const Plan& plan, const RecordSource& runs, const RecordSource& floor);

/// The same from records in memory.
void write_tables(const StudyPaths& paths, const Plan& plan, const std::vector<Record>& runs,
                  const std::vector<Record>& floor);

/// The tables of a study, or of several that have been merged.
struct Tables {
  Plan plan;
  std::vector<Record> runs;
  std::vector<Record> floor;
};

/// Reads the tables of one study.
/// @throws IoError when the directory is not that of a study, or a table cannot be read
Tables read_tables(const std::filesystem::path& directory);

/// Joins the tables of studies of the same case and seed. A realization may stand in several of them if its digest is
/// the same; where it failed in one and is done in another, it is done.
/// @throws ConfigError naming every difference: case hash, seed, version, sampling, or a realization with two results
Tables merge(const std::vector<std::filesystem::path>& directories);

/// Makes `out` the directory of a merged study: tables, study.json, plan, and the case of `origin`, one of the
/// directories merged.
/// @throws IoError when `out` holds anything but an earlier merge of the same case
void write_merged(const std::filesystem::path& out, const Tables& tables, const std::filesystem::path& origin);

}  // namespace talus
