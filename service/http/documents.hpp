#pragma once
// Documents compiled into the program: schemas/openapi.json and schemas/processes/*.json.

#include <string>
#include <utility>
#include <vector>

namespace talus::service {

const std::string& openapi_text();
/// Name and text of every process description, in order.
const std::vector<std::pair<std::string, std::string>>& process_texts();

}  // namespace talus::service
