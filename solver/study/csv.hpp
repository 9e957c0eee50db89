#pragma once
// realizations.csv and noise_floor.csv: one line per record, in order of index; RFC 4180, header first, numbers that
// read back exactly.

#include <filesystem>
#include <string>
#include <vector>

#include "study/record.hpp"

namespace talus {

/// The first line of a table; `index_name` heads the first column ("index", "replicate").
std::string csv_header(const std::string& index_name);
/// The line of a record.
std::string csv_line(const Record& record);

/// The table of `records`; `index_name` heads the first column ("index", "replicate").
std::string to_csv(const std::vector<Record>& records, const std::string& index_name);

/// Reads such a table.
/// @throws IoError naming file and line: another header, a wrong number of fields, not a number, indices out of order
/// or twice
std::vector<Record> read_csv(const std::filesystem::path& path, const std::string& index_name);

}  // namespace talus
