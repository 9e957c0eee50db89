#pragma once
// Files compiled into the program (embed_documents.cmake).

#include <string>
#include <utility>
#include <vector>

namespace talus::service {

using Documents = std::vector<std::pair<std::string, std::string>>;  ///< name without extension, text
const Documents& schemas();                                          ///< schemas/openapi.json
const Documents& processes();                                        ///< schemas/processes/, in the order of the API
const Documents& migrations();                                       ///< queue/migrations/, in order

}  // namespace talus::service
