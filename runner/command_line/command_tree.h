// What the command line is made of: read off the parser's own verbs and options, so that completion and
// manual pages cannot say anything else.
#pragma once

#include <string>
#include <vector>

#include "runner/command_line/verb_page.h"

namespace peclet::runner {

// What options.cpp calls the values of options; completion offers files by them.
namespace value_name {
constexpr const char* campaign_file = "FILE.json";
constexpr const char* campaign = "CAMPAIGN";  // a campaign file, or its .peclet folder
constexpr const char* file = "FILE";
constexpr const char* folder = "FOLDER";
}  // namespace value_name

struct CommandOption {
  std::string name;        // "--workers"; of a positional one "campaign"
  std::string short_name;  // "-h", or ""
  std::string value;       // "NUMBER", "FOLDER"; "" for a flag
  std::vector<std::string> choices;
  std::string meaning;
  std::string default_value;  // "" where there is none, or none to be shown
  bool positional = false, required = false, repeatable = false;

  bool takes_value() const { return !value.empty(); }
};

struct CommandVerb {
  std::string name;
  std::string summary;  // one line
  std::string example;
  std::vector<CommandOption> options;
  VerbPage page;

  std::vector<CommandOption> positionals() const;
  std::vector<CommandOption> named() const;
};

struct CommandTree {
  std::string summary;
  std::vector<CommandOption> options;  // before any verb
  std::vector<CommandVerb> verbs;
};

// Of `peclet`: all verbs and options.
CommandTree command_tree();

}  // namespace peclet::runner
