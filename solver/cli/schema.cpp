// talus schema: prints a JSON Schema, the names of the schemas, or the keys of a case.

#include "case/schema.hpp"

#include <iostream>
#include <memory>

#include "cli/help.hpp"
#include "cli/schemas.hpp"
#include "cli/verbs.hpp"
#include "support/text.hpp"

namespace talus::cli {
namespace {

std::vector<std::pair<std::string, std::string>> all_schemas() {
  auto all = schemas();
  all.emplace(all.begin(), "case", case_schema().dump(2) + "\n");
  return all;
}

/// Path, description and, of a choice, its words: three columns separated by tabs.
Exit print_keys() {
  for (const CaseKey& key : case_keys()) {
    std::cout << key.path << "\t" << key.description << "\t";
    for (const std::string& word : key.choices) std::cout << word << " ";
    std::cout << "\n";
  }
  return Exit::ok;
}

Exit print_schema(const std::string& name) {
  std::vector<std::string> known;
  for (const auto& [schema, text] : all_schemas()) {
    known.push_back(schema);
    if (schema == name) std::cout << text;
    if (schema == name) return Exit::ok;
    if (name.empty()) std::cout << schema << "\n";
  }
  if (name.empty()) return Exit::ok;
  std::cerr << "no schema is called " << in_quotes(name) << suggestion(name, known) << "\n";
  return Exit::usage;
}

}  // namespace

void add_schema(CLI::App& app, Action& action) {
  const auto name = std::make_shared<std::string>();
  const auto keys = std::make_shared<bool>(false);
  CLI::App* verb = app.add_subcommand("schema", "Print the JSON Schema of a file, or list the schemas");
  verb->add_option("NAME", *name, "Schema to print; without it the names are listed");
  verb->add_flag("--keys", *keys, "List the keys of a case that --set takes, with meaning, unit, range and default");
  set_footer(*verb, {}, {"schema", "schema case", "schema --keys"});
  verb->callback(
      [&action, name, keys] { action = [name, keys] { return *keys ? print_keys() : print_schema(*name); }; });
}

}  // namespace talus::cli
