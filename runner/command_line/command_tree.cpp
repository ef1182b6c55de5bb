#include "runner/command_line/command_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <sstream>

namespace peclet::runner {
namespace {

std::vector<CommandOption> those(const std::vector<CommandOption>& options, bool positional) {
  std::vector<CommandOption> found;
  std::copy_if(options.begin(), options.end(), std::back_inserter(found),
               [&](const CommandOption& option) { return option.positional == positional; });
  return found;
}

}  // namespace

std::vector<CommandOption> CommandVerb::positionals() const { return those(options, true); }

std::vector<CommandOption> CommandVerb::named() const { return those(options, false); }

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

// One function of bash finds the verb, the option that waits for a value, or the place of the word among
// those that are no options.

namespace {

// {0} the options, {1} the verbs, {2} per verb its options and the ones with a value, {3} what follows an
// option, {4} what stands at a place.
constexpr const char* script =
    R"script(# Completion of peclet for bash. Use it with: eval "$(peclet completion bash)"
_peclet_words() {{ mapfile -t COMPREPLY < <(compgen -W "$1" -- "$word"); }}
_peclet_folders() {{
  compopt -o filenames 2>/dev/null
  mapfile -t COMPREPLY < <(compgen -d -- "$word")
}}
_peclet_files() {{
  compopt -o filenames 2>/dev/null
  mapfile -t COMPREPLY < <(compgen -f -- "$word")
}}
# Campaign files, and folders on the way to them.
_peclet_campaign_files() {{
  compopt -o filenames 2>/dev/null
  mapfile -t COMPREPLY < <(compgen -d -X '*.peclet' -- "$word"; compgen -f -X '!*.json' -- "$word")
}}
_peclet_campaigns() {{
  compopt -o filenames 2>/dev/null
  mapfile -t COMPREPLY < <(compgen -d -- "$word"; compgen -f -X '!*.json' -- "$word")
}}
_peclet() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} verb='' options='' valued='' previous='' place=0 i
  COMPREPLY=()
  for ((i = 1; i < COMP_CWORD; ++i)); do
    local this=${{COMP_WORDS[i]}}
    if [[ $this == '=' ]]; then
      previous=${{previous:-=}}
    elif [[ -n $previous ]]; then
      previous=''
    elif [[ $this == -* ]]; then
      [[ " $valued " == *" $this "* ]] && previous=$this
    elif [[ -z $verb ]]; then
      verb=$this
      case $verb in
{2}      esac
    else
      ((++place))
    fi
  done
  [[ $word == '=' ]] && word=''
  if [[ -n $previous ]]; then
    case $verb:$previous in
{3}    esac
  elif [[ -z $verb && $word != -* ]]; then
    _peclet_words '{1}'
  elif [[ -z $verb ]]; then
    _peclet_words '{0}'
  elif [[ $word == -* ]]; then
    _peclet_words "$options"
  else
    case $verb:$place in
{4}    esac
  fi
}}
complete -F _peclet peclet
)script";

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

std::vector<std::string> names(const std::vector<CommandOption>& options, bool valued_only) {
  std::vector<std::string> found;
  for (const CommandOption& option : options) {
    if (!valued_only || option.takes_value()) found.push_back(option.name);
  }
  return found;
}

// "" for a value that only its user knows.
std::string offer(const CommandOption& option) {
  if (!option.choices.empty()) return "_peclet_words '" + joined(option.choices) + "'";
  if (option.value == value_name::campaign_file) return "_peclet_campaign_files";
  if (option.value == value_name::campaign) return "_peclet_campaigns";
  if (option.value == value_name::file) return "_peclet_files";
  if (option.value == value_name::folder) return "_peclet_folders";
  return "";
}

std::string branch(const std::string& pattern, const std::string& action) {
  return action.empty() ? "" : fmt::format("      {}) {} ;;\n", pattern, action);
}

}  // namespace

std::string bash_completion(const CommandTree& tree) {
  std::vector<std::string> verbs;
  std::string options, after_option, at_place;
  for (const CommandVerb& verb : tree.verbs) {
    verbs.push_back(verb.name);
    const std::vector<CommandOption> named = verb.named();
    options += fmt::format("        {}) options='{}' valued='{}' ;;\n", verb.name,
                           joined(names(named, false)), joined(names(named, true)));
    for (const CommandOption& option : named) {
      after_option += branch(verb.name + ':' + option.name, offer(option));
    }
    const std::vector<CommandOption> positionals = verb.positionals();
    for (std::size_t place = 0; place < positionals.size(); ++place) {
      at_place += branch(fmt::format("{}:{}", verb.name, place), offer(positionals[place]));
    }
  }
  return fmt::format(fmt::runtime(script), joined(names(tree.options, false)), joined(verbs), options,
                     after_option, at_place);
}

}  // namespace peclet::runner
