// talus schema NAME: prints a JSON Schema; without a name lists them.

#include <iostream>
#include <memory>

#include "case/words.hpp"
#include "cli/schemas.hpp"
#include "cli/verbs.hpp"

namespace talus::cli {
namespace {

Exit print_schema(const std::string& name) {
  std::vector<std::string> known;
  for (const auto& [schema, text] : schemas()) {
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
  CLI::App* verb = app.add_subcommand("schema", "print the JSON Schema of a file, or list the schemas");
  verb->add_option("NAME", *name, "which one; none: list them");
  verb->callback([&action, name] { action = [name] { return print_schema(*name); }; });
}

}  // namespace talus::cli
