#pragma once
// A JSON Schema as an independent library reads it (valijson, draft 7), and the examples of the repository.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>
#include <vector>

namespace talus::test {

inline std::string slurp(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + path.string());
  return {std::istreambuf_iterator<char>(in), {}};
}

inline std::filesystem::path source(const std::string& path) { return std::filesystem::path(TALUS_SOURCE_DIR) / path; }

/// schemas/NAME.schema.json
class SchemaCheck {
 public:
  explicit SchemaCheck(const std::string& name)
      : document_(nlohmann::json::parse(slurp(source("schemas/" + name + ".schema.json")))) {
    valijson::SchemaParser parser(valijson::SchemaParser::kDraft7);
    valijson::adapters::NlohmannJsonAdapter adapter(document_);
    parser.populateSchema(adapter, schema_);
  }
  const nlohmann::json& document() const { return document_; }

  /// What the schema has against a document; "" when nothing.
  std::string complaint(const nlohmann::json& document) const {
    valijson::Validator validator;
    valijson::ValidationResults results;
    valijson::adapters::NlohmannJsonAdapter adapter(document);
    if (validator.validate(schema_, adapter, &results)) return "";
    std::string text = "refused";
    valijson::ValidationResults::Error error;
    while (results.popError(error)) {
      text += "\n";
      for (const std::string& part : error.context) text += part;
      text += ": " + error.description;
    }
    return text;
  }

 private:
  nlohmann::json document_;
  valijson::Schema schema_;
};

/// The files of a directory whose names begin and end so, sorted.
inline std::vector<std::filesystem::path> files(const std::string& directory, const std::string& begin,
                                                const std::string& end) {
  std::vector<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::directory_iterator(source(directory))) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(begin) && name.ends_with(end)) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace talus::test
