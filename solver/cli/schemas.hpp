#pragma once

#include <string>
#include <utility>
#include <vector>

namespace talus::cli {

/// Name and text of every schema in schemas/, compiled into the program.
const std::vector<std::pair<std::string, std::string>>& schemas();

}  // namespace talus::cli
