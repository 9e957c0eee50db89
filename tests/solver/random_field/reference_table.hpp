#pragma once
// Tables of data/, made by data/make_references.py with other packages.

#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "random_field/covariance.hpp"

namespace talus::test {

/// Rows as column -> text.
inline std::vector<std::map<std::string, std::string>> reference_table(const std::string& name) {
  std::ifstream file(std::string(TALUS_SOURCE_DIR) + "/tests/solver/random_field/data/" + name);
  if (!file) throw std::runtime_error("cannot read " + name);
  const auto fields = [](const std::string& line) {
    std::vector<std::string> out;
    std::istringstream cells(line + ",");
    for (std::string cell; std::getline(cells, cell, ',');) out.push_back(cell);
    return out;
  };
  std::string line;
  std::getline(file, line);  // versions
  std::getline(file, line);
  const std::vector<std::string> columns = fields(line);
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(file, line)) {
    const std::vector<std::string> cells = fields(line);
    auto& row = rows.emplace_back();
    for (std::size_t k = 0; k < columns.size(); ++k) row[columns[k]] = cells.at(k);
  }
  return rows;
}

inline Covariance family_named(const std::string& name) {
  const std::map<std::string, Covariance> names{{"exponential", Covariance::exponential},
                                                {"exponential_isotropic", Covariance::exponential_isotropic},
                                                {"squared_exponential", Covariance::squared_exponential},
                                                {"matern_3_2", Covariance::matern_3_2},
                                                {"matern_5_2", Covariance::matern_5_2},
                                                {"cosine_exponential", Covariance::cosine_exponential}};
  return names.at(name);
}

}  // namespace talus::test
