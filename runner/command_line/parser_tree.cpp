#include "runner/command_line/parser_tree.h"

#include <sstream>

namespace peclet::runner {
namespace {

// The parser's "INT:INT in [1 - 100]" and "TEXT:{bash,zsh}" are the name of the value and its check.
std::string value_of(const CLI::Option& option) {
  if (option.get_items_expected_max() == 0) return "";  // a flag
  const std::string name = option.get_type_name().substr(0, option.get_type_name().find(':'));
  return name == "INT" || name == "UINT" || name == "FLOAT" ? "NUMBER" : name;
}

std::vector<std::string> choices_of(const CLI::Option& option) {
  const std::string name = option.get_type_name();
  const std::size_t begin = name.find(":{"), end = name.find('}');
  std::vector<std::string> choices;
  if (begin == std::string::npos || end == std::string::npos) return choices;
  std::istringstream words(name.substr(begin + 2, end - begin - 2));
  for (std::string word; std::getline(words, word, ',');) choices.push_back(word);
  return choices;
}

CommandOption option_of(const CLI::Option& option) {
  CommandOption described;
  described.positional = option.get_positional();
  described.name = described.positional ? option.get_name(true) : "--" + option.get_lnames().front();
  described.value = value_of(option);
  described.choices = choices_of(option);
  described.default_value = option.get_default_str();
  described.repeatable = option.get_expected_max() > 1;
  return described;
}

}  // namespace

CommandTree describe(const CLI::App& app) {
  CommandTree tree;
  for (const CLI::Option* option : app.get_options()) tree.options.push_back(option_of(*option));
  for (const CLI::App* verb : app.get_subcommands(std::function<bool(const CLI::App*)>())) {
    CommandVerb described{verb->get_name(), {}};
    for (const CLI::Option* option : verb->get_options()) described.options.push_back(option_of(*option));
    tree.verbs.push_back(std::move(described));
  }
  return tree;
}

std::string HelpFormatter::make_option_opts(const CLI::Option* option) const {
  const CommandOption about = option_of(*option);
  std::string text = about.takes_value() ? " " + about.value : "";
  if (!about.default_value.empty()) text += "=" + about.default_value;
  return about.repeatable ? text + " ..." : text;
}

}  // namespace peclet::runner
