#pragma once

#include <string>
#include <utility>
#include <vector>

namespace talus::cli {

/// Name and text of every schema in schemas/, compiled into the program.
const std::vector<std::pair<std::string, std::string>>& schemas();
/// The same for the cases that come with the program.
const std::vector<std::pair<std::string, std::string>>& cases();

}  // namespace talus::cli
