#pragma once
// What --help prints, and what is said about a command line that is wrong.

#include <CLI/CLI.hpp>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "support/error.hpp"

namespace talus::cli {

/// An option that is spelt otherwise in British English; the spelling works and is not shown.
struct OptionAlias {
  std::string_view alias;
  std::string_view name;
};
inline constexpr OptionAlias option_aliases[] = {{"--realisation", "--realization"},
                                                 {"--realisations", "--realizations"}};

/// The command line in the words that the program declares: aliases replaced, `help VERB` as `VERB --help`.
std::vector<std::string> normalized(std::vector<std::string> arguments);

/// One grammar for the help of every verb: METAVARIABLES in capitals, ranges, choices and defaults in parentheses
/// behind a sentence; whole numbers may be written as 1e3. To be called once, when all verbs have been added.
void format_help(CLI::App& app);

/// The exit codes that only some verbs end with.
namespace exit_text {
inline constexpr std::string_view bad_case = "3 bad case", diverged = "4 diverged", io = "5 input/output",
                                  stopped = "6 stopped, can be resumed", dismissed = "6 dismissed",
                                  failed = "7 too many failed runs";
}

/// Closes the help of a verb: examples, and the exit codes it can end with beside 0, 1 and 2.
void set_footer(CLI::App& verb, std::initializer_list<std::string_view> codes,
                std::initializer_list<std::string_view> examples);

/// The options that several verbs share.
void add_case(CLI::App& verb, std::filesystem::path& file);
void add_overrides(CLI::App& verb, std::vector<std::string>& overrides);

/// Accepts a file name that ends in one of `known`, such as .svg.
CLI::Validator has_ending(std::vector<std::string> known);

/// "warning: /material/density_kg_m3 19.4 kg/m3 is unusual ..." on stderr, a line each.
void print_warnings(const std::vector<Fault>& warnings);

/// Draws the figures of a run or study that is done; those that cannot be drawn are no reason to fail.
void draw_figures(const std::filesystem::path& directory,
                  std::vector<std::filesystem::path> (*draw)(const std::filesystem::path&));

/// Whether a parse ended because help or the version is to be printed, of a command that exists.
bool asks_for_help(const CLI::App& app, const std::vector<std::string>& arguments, const CLI::ParseError& error);

/// What is wrong with a command line, and what may have been meant.
std::string usage_message(const CLI::App& app, const std::vector<std::string>& arguments, const CLI::ParseError& error);

}  // namespace talus::cli
