#include "schema_check.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <stdexcept>

// libvalijson 1.0 leaves a parameter of its own unused.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>
#pragma GCC diagnostic pop

namespace talus::test {

std::string slurp(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + path.string());
  return {std::istreambuf_iterator<char>(in), {}};
}

std::filesystem::path source(const std::string& path) { return std::filesystem::path(TALUS_SOURCE_DIR) / path; }

std::vector<std::filesystem::path> files(const std::string& directory, const std::string& begin,
                                         const std::string& end) {
  std::vector<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::directory_iterator(source(directory))) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(begin) && name.ends_with(end)) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

using Adapter = valijson::adapters::NlohmannJsonAdapter;

struct SchemaCheck::Parsed {
  valijson::Schema schema;
};

SchemaCheck::SchemaCheck(const std::string& name)
    : document_(nlohmann::json::parse(slurp(source("schemas/" + name + ".schema.json")))),
      schema_(std::make_unique<Parsed>()) {
  valijson::SchemaParser(valijson::SchemaParser::kDraft7).populateSchema(Adapter(document_), schema_->schema);
}

SchemaCheck::~SchemaCheck() = default;

std::string SchemaCheck::complaint(const nlohmann::json& document) const {
  valijson::ValidationResults results;
  if (valijson::Validator().validate(schema_->schema, Adapter(document), &results)) return "";
  std::string text = "refused";
  valijson::ValidationResults::Error error;
  while (results.popError(error)) {
    text += "\n";
    for (const std::string& part : error.context) text += part;
    text += ": " + error.description;
  }
  return text;
}

}  // namespace talus::test
