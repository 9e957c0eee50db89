#pragma once
// Coefficients of a random field from a text file, as [Z20] Table 2 gives them.

#include <filesystem>
#include <vector>

namespace talus::cli {

/// The numbers of a file: one a line, or the column `xi` (without such a header: the last one) of a CSV. Blank lines
/// and lines that start with # are passed over; the first line may be a header.
/// @throws IoError when the file cannot be read
/// @throws ConfigError naming file:line of what is not a finite number; also when there is none at all
std::vector<double> read_xi(const std::filesystem::path& path);

}  // namespace talus::cli
