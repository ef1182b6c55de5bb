#include <fmt/format.h>

#include <algorithm>

#include "runner/command_line/verb_set.h"

namespace peclet::runner {
namespace {

// Returns the name of the option's value, "" for a flag. The parser's "INT:INT in [1 - 100]" and
// "TEXT:{bash,zsh}" are the name of the value and its check.
std::string value_of(const CLI::Option& option) {
  if (option.get_items_expected_max() == 0) return "";
  const std::string name = option.get_type_name().substr(0, option.get_type_name().find(':'));
  return name == "INT" || name == "UINT" || name == "FLOAT" ? "NUMBER" : name;
}

}  // namespace

std::string HelpFormatter::make_option_opts(const CLI::Option* option) const {
  const std::string value = value_of(*option), usual = option->get_default_str();
  return (value.empty() ? "" : " " + value) + (usual.empty() ? "" : "=" + usual) +
         (option->get_expected_max() > 1 ? " ..." : "");
}

namespace {

// Placeholders: {0} options before a verb, {1} verbs, {2} options of each verb and those that take a value,
// {3} what completes the value of an option, {4} what completes a positional word.
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

// Returns the bash command that completes the option's value; "" if nothing can be offered.
std::string offer(const CLI::Option& option) {
  const std::string type = option.get_type_name(), value = value_of(option);
  if (const std::size_t begin = type.find(":{"); begin != std::string::npos) {
    std::string choices = type.substr(begin + 2, type.find('}') - begin - 2);
    std::replace(choices.begin(), choices.end(), ',', ' ');
    return "_peclet_words '" + choices + "'";
  }
  if (value == "FILE.json") return "_peclet_campaign_files";
  if (value == "CAMPAIGN") return "_peclet_campaigns";
  if (value == "FILE") return "_peclet_files";
  if (value == "FOLDER") return "_peclet_folders";
  return "";
}

void append(std::string& words, const std::string& word) { words += (words.empty() ? "" : " ") + word; }

std::string branch(const std::string& verb, const std::string& place, const CLI::Option& option) {
  const std::string action = offer(option);
  return action.empty() ? "" : fmt::format("      {}:{}) {} ;;\n", verb, place, action);
}

}  // namespace

std::string bash_completion(const CLI::App& app) {
  std::string before, verbs, options, after_option, at_place;
  for (const CLI::Option* option : app.get_options()) append(before, "--" + option->get_lnames().front());
  for (const CLI::App* verb : app.get_subcommands(std::function<bool(const CLI::App*)>())) {
    append(verbs, verb->get_name());
    std::string names, valued;
    int place = 0;
    for (const CLI::Option* option : verb->get_options()) {
      if (option->get_positional()) {
        at_place += branch(verb->get_name(), std::to_string(place++), *option);
        continue;
      }
      const std::string name = "--" + option->get_lnames().front();
      append(names, name);
      if (!value_of(*option).empty()) append(valued, name);
      after_option += branch(verb->get_name(), name, *option);
    }
    options += fmt::format("        {}) options='{}' valued='{}' ;;\n", verb->get_name(), names, valued);
  }
  return fmt::format(fmt::runtime(script), before, verbs, options, after_option, at_place);
}

}  // namespace peclet::runner
