#pragma once
// A JSON Schema as an independent library (valijson, draft 7) reads it, and the files of the repository. In a library
// of its own, because valijson takes 13 s to compile.

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace talus::test {

/// The whole of a file. @throws std::runtime_error
std::string slurp(const std::filesystem::path& path);

/// A path in the repository.
std::filesystem::path source(const std::string& path);

/// The files of a directory of the repository whose names begin and end so, sorted.
std::vector<std::filesystem::path> files(const std::string& directory, const std::string& begin,
                                         const std::string& end);

/// schemas/NAME.schema.json
class SchemaCheck {
 public:
  explicit SchemaCheck(const std::string& name);
  ~SchemaCheck();

  const nlohmann::json& document() const { return document_; }
  /// What the schema has against a document, one fault a line; "" when nothing.
  std::string complaint(const nlohmann::json& document) const;

 private:
  struct Parsed;
  nlohmann::json document_;
  std::unique_ptr<Parsed> schema_;
};

}  // namespace talus::test
