// What the command line is made of: read off the parser's own verbs and options, so that completion cannot
// say anything else.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

namespace peclet::runner {

// What options.cpp calls the values of options; completion offers files by them.
namespace value_name {
constexpr const char* campaign_file = "FILE.json";
constexpr const char* campaign = "CAMPAIGN";  // a campaign file, or its .peclet folder
constexpr const char* file = "FILE";
constexpr const char* folder = "FOLDER";
}  // namespace value_name

struct CommandOption {
  std::string name;   // "--workers"; of a positional one "campaign"
  std::string value;  // "NUMBER", "FOLDER"; "" for a flag
  std::vector<std::string> choices;
  std::string default_value;  // "" where there is none, or none to be shown
  bool positional = false, repeatable = false;

  bool takes_value() const { return !value.empty(); }
};

struct CommandVerb {
  std::string name;
  std::vector<CommandOption> options;

  std::vector<CommandOption> positionals() const;
  std::vector<CommandOption> named() const;
};

struct CommandTree {
  std::vector<CommandOption> options;  // before any verb
  std::vector<CommandVerb> verbs;
};

// Of `peclet`: all verbs and options.
CommandTree command_tree();

// The command tree of a parser, and how the parser prints its options.
CommandTree describe(const CLI::App& app);

// Prints values without the parser's own words for their checks: "--threads NUMBER=1".
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option_opts(const CLI::Option* option) const override;
};

// The verb `peclet completion`: what bash needs to complete command lines of peclet.
struct CompletionOptions {
  std::string shell;             // bash
  std::filesystem::path output;  // "": standard output
  bool quiet = false;            // does not say where it is
};

// A script for `eval`, or for a file in bash's own folder of completions. Verbs, options, choices, and files
// where an option takes some: campaign files (*.json), .peclet folders, any file, any folder.
std::string bash_completion(const CommandTree& tree);

}  // namespace peclet::runner
