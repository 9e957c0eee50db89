#include "cli/help.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <iostream>
#include <memory>

#include "support/text.hpp"

namespace talus::cli {
namespace {

std::string upper(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

/// With a capital first letter, unless the first word is a name such as study.json or rk2.
std::string sentence(std::string text) {
  const std::size_t end = text.find_first_not_of("abcdefghijklmnopqrstuvwxyz");
  if (end != 0 && (end == std::string::npos || text[end] == ' ' || text[end] == ',')) text[0] -= 'a' - 'A';
  return text;
}

/// "INT:INT in [1 - 4096]" -> {"INT", "INT in [1 - 4096]"}: the type and what its checks say.
std::pair<std::string, std::string> split_type(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t colon = type.find(':');
  return {type.substr(0, colon), colon == std::string::npos ? "" : type.substr(colon + 1)};
}

std::string metavariable(const CLI::Option& option) {
  const std::string type = split_type(option).first;
  if (type == "INT" || type == "UINT") return "N";
  if (type == "FLOAT") return "NUMBER";
  return type == "TEXT" ? upper(option.get_single_name()) : type;
}

/// "1 to 4096", "0 or more", "one of local, slurm"
std::string range_of(const CLI::Option& option) {
  std::string check = split_type(option).second;
  if (check == "NONNEGATIVE") return "0 or more";
  if (const auto open = check.find('['), dash = check.find(" - ");
      open != std::string::npos && dash != std::string::npos)
    return check.substr(open + 1, dash - open - 1) + " to " + check.substr(dash + 3, check.find(']') - dash - 3);
  if (!check.starts_with('{')) return "";
  std::string words;
  for (const char c : check.substr(1, check.size() - 2)) words += c == ',' ? ", " : std::string(1, c);
  return "one of " + words;
}

class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option_name(const CLI::Option* option, bool positional) const override {
    return positional ? upper(option->get_name(true, false)) : option->get_name(false, true);
  }
  std::string make_option_opts(const CLI::Option* option) const override {
    if (option->get_type_size() == 0 || option->get_positional()) return "";
    const bool list = option->get_delimiter() != '\0';
    return " " + metavariable(*option) + (list ? ",..." : "");
  }
  std::string make_option_desc(const CLI::Option* option) const override {
    std::vector<std::string> remarks;
    if (option->get_required()) remarks.emplace_back("required");
    if (const std::string range = range_of(*option); !range.empty()) remarks.push_back(range);
    if (const std::string text = option->get_default_str(); !text.empty()) remarks.push_back("default " + text);
    if (!option->get_envname().empty()) remarks.push_back("or $" + option->get_envname());
    for (const CLI::Option* other : option->get_excludes()) remarks.push_back("not with " + other->get_name());
    std::string all;
    for (const std::string& remark : remarks) all += (all.empty() ? " (" : "; ") + remark;
    return sentence(option->get_description()) + all + (all.empty() ? "" : ")");
  }
  std::string make_usage(const CLI::App* app, std::string name) const override {
    if (app->get_parent() == nullptr) return "Usage: talus COMMAND [OPTIONS]\n       talus help COMMAND\n";
    return CLI::Formatter::make_usage(app, std::move(name));
  }
};

/// Takes 1e3 as 1000.
const CLI::Validator whole_number(
    [](std::string& text) -> std::string {
      double x = 0.0;
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
      if (error != std::errc{} || end != text.data() + text.size()) return "";  // the conversion will say so
      if (x != std::floor(x)) return in_quotes(text) + " is not a whole number";
      if (text.find_first_of("eE.") != std::string::npos && std::abs(x) < 9007199254740992.0)
        text = std::to_string(static_cast<long long>(x));
      return "";
    },
    "");

std::vector<const CLI::App*> visible_verbs(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* verb) { return !verb->get_group().empty(); });
}

std::vector<std::string> verb_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* verb : visible_verbs(app)) names.push_back(verb->get_name());
  return names;
}

const CLI::App* find_verb(const CLI::App& app, const std::string& name) {
  const auto found = app.get_subcommands([&](const CLI::App* verb) { return verb->get_name() == name; });
  return found.empty() ? nullptr : found.front();
}

bool has_option(const CLI::App& verb, const std::string& name) { return verb.get_option_no_throw(name) != nullptr; }

std::vector<std::string> option_names(const CLI::App& verb) {
  std::vector<std::string> names;
  for (const CLI::Option* option : verb.get_options())
    if (option->nonpositional() && !option->get_group().empty()) names.push_back(option->get_single_name());
  return names;
}

std::string unknown_option(const CLI::App& app, const CLI::App& verb, const std::string& name) {
  std::string text = name + " is not an option of talus " + verb.get_name();
  if (const std::string near = nearest_name(name.substr(2), option_names(verb)); !near.empty())
    text += " (--" + near + "?)";
  std::string owners;
  for (const CLI::App* other : visible_verbs(app))
    if (has_option(*other, name)) owners += (owners.empty() ? "" : ", ") + other->get_name();
  return owners.empty() ? text : text + "; it is an option of: " + owners;
}

}  // namespace

std::vector<std::string> normalized(std::vector<std::string> arguments) {
  if (!arguments.empty() && arguments[0] == "help") {
    arguments.erase(arguments.begin());
    arguments.insert(arguments.begin() + (arguments.empty() ? 0 : 1), "--help");
  }
  for (std::string& argument : arguments)
    for (const auto& [alias, name] : option_aliases)
      if (argument == alias || argument.starts_with(std::string(alias) + "=")) argument.replace(0, alias.size(), name);
  return arguments;
}

void format_help(CLI::App& app) {
  const auto formatter = std::make_shared<HelpFormatter>();
  app.formatter(formatter);
  app.get_help_ptr()->description("Print this help and exit");
  for (CLI::App* verb : app.get_subcommands({})) {
    verb->formatter(formatter);
    if (verb->get_group() == "Subcommands") verb->group("Commands");
    verb->get_help_ptr()->description("Print this help and exit");
    for (CLI::Option* option : verb->get_options())
      if (const std::string type = split_type(*option).first; type == "INT" || type == "UINT")
        option->transform(whole_number);
  }
}

void set_footer(CLI::App& verb, std::initializer_list<std::string_view> codes,
                std::initializer_list<std::string_view> examples) {
  std::string text = "Examples:\n";
  for (const std::string_view example : examples) text += "  talus " + std::string(example) + "\n";
  text += "\nExit codes: 0 ok, 1 internal error, 2 usage";
  for (const std::string_view code : codes) text += ", " + std::string(code);
  verb.footer(text);
}

bool asks_for_help(const CLI::App& app, const std::vector<std::string>& arguments, const CLI::ParseError& error) {
  return error.get_exit_code() == 0 && (arguments[0].starts_with('-') || find_verb(app, arguments[0]) != nullptr);
}

void add_case(CLI::App& verb, std::filesystem::path& file) {
  verb.add_option("CASE", file, "Case file (JSON)")->required();
}

void add_overrides(CLI::App& verb, std::vector<std::string>& overrides) {
  verb.add_option("--set", overrides,
                  "Override a key of the case; null removes it; repeatable; talus schema --keys lists the keys")
      ->type_name("KEY=VALUE")
      ->take_all()
      ->allow_extra_args(false);
}

CLI::Validator has_ending(std::vector<std::string> known) {
  return CLI::Validator(
      [known = std::move(known)](const std::string& path) {
        std::string list;
        for (const std::string& ending : known) {
          if (path.ends_with(ending)) return std::string();
          list += (list.empty() ? "" : &ending == &known.back() ? " or " : ", ") + ending;
        }
        return path + " must end in " + list;
      },
      "");
}

void print_warnings(const std::vector<Fault>& warnings) {
  for (const Fault& w : warnings) std::cerr << "warning: " << w.pointer << " " << w.message << "\n";
}

void draw_figures(const std::filesystem::path& directory,
                  std::vector<std::filesystem::path> (*draw)(const std::filesystem::path&)) try {
  draw(directory);
  std::cerr << "figures: " << (directory / "figures").string() << "\n";
} catch (const IoError& e) {
  std::cerr << "no figures: " << e.what() << "\n";
}

std::string usage_message(const CLI::App& app, const std::vector<std::string>& arguments,
                          const CLI::ParseError& error) {
  if (arguments.empty()) return "a command is required; talus --help lists them";
  const std::string& name = arguments[0];
  if (name.starts_with('-')) return name + " is not an option of talus; talus --help lists commands and options";
  const CLI::App* verb = find_verb(app, name);
  if (verb == nullptr) return in_quotes(name) + " is not a command of talus" + suggestion(name, verb_names(app));
  std::string message = error.what();
  for (const std::string& argument : arguments)
    if (const std::string option = argument.substr(0, argument.find('='));
        option.starts_with("--") && !has_option(*verb, option)) {
      message = unknown_option(app, *verb, option);
      break;
    }
  return message + "\ntalus help " + name + " explains its options";
}

}  // namespace talus::cli
