// Completion for zsh and fish, whose own functions do most of the work; bash is in completion_bash.cpp.
#include "runner/command_line/completion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cassert>

namespace peclet::runner {
namespace {

// Backslashes before each of `characters`.
std::string with_backslashes(const std::string& text, const std::string& characters) {
  std::string safe;
  for (const char c : text) {
    if (characters.find(c) != std::string::npos) safe += '\\';
    safe += c;
  }
  return safe;
}

// A word between single quotes, for zsh: these have no escapes inside.
std::string zsh_quoted(const std::string& text) {
  std::string safe = "'";
  for (const char c : text) safe += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return safe + "'";
}

std::string fish_quoted(const std::string& text) { return "'" + with_backslashes(text, "\\'") + "'"; }

std::string listed(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, " ")); }

std::string zsh_action(const CommandOption& option) {
  if (!option.choices.empty()) return "(" + listed(option.choices) + ")";
  if (option.value == value_name::campaign_file) return "_files -g \"*.json\"";
  if (option.value == value_name::campaign) return "_files -g \"(*.json|*.peclet(/))\"";
  if (option.value == value_name::file) return "_files";
  if (option.value == value_name::folder) return "_files -/";
  return " ";
}

// "'--workers[Engine processes]:NUMBER: '", "'1:campaign:_files'"
std::string zsh_argument(const CommandOption& option, std::size_t place) {
  std::string text;
  if (option.positional) {
    text = fmt::format("{}:{}:{}", place, with_backslashes(option.name, ":"), zsh_action(option));
  } else {
    text = fmt::format("{}{}[{}]", option.repeatable ? "*" : "", option.name,
                       with_backslashes(option.meaning, "[]\\:"));
    if (option.takes_value()) text += ":" + with_backslashes(option.value, ":") + ":" + zsh_action(option);
  }
  return zsh_quoted(text);
}

std::string zsh_arguments(const std::vector<CommandOption>& options) {
  std::string text;
  std::size_t place = 0;
  for (const CommandOption& option : options) {
    text += " \\\n        " + zsh_argument(option, option.positional ? ++place : 0);
  }
  return text;
}

// {0} the options, {1} the verbs, {2} per verb its arguments.
constexpr const char* zsh_script = R"script(#compdef peclet
# Completion of peclet for zsh. Use it with: eval "$(peclet completion zsh)"
_peclet() {{
  local context state state_descr line
  typeset -A opt_args
  _arguments -C{0} \
        '1:verb:->verb' '*::argument:->argument'
  case $state in
    verb)
      local -a verbs=({1})
      _describe verb verbs
      ;;
    argument)
      case $words[1] in
{2}      esac
      ;;
  esac
}}
if [[ $funcstack[1] == _peclet ]]; then _peclet "$@"; else compdef _peclet peclet; fi
)script";

// How fish completes a value: -x takes nothing but what follows, -r a file as well.
std::string fish_value(const CommandOption& option) {
  if (!option.choices.empty()) return " -x -a " + fish_quoted(listed(option.choices));
  if (option.value == value_name::campaign_file || option.value == value_name::campaign) {
    return " -x -a '(__fish_complete_suffix .json)'";
  }
  if (option.value == value_name::file) return " -r -F";
  if (option.value == value_name::folder) return " -x -a '(__fish_complete_directories)'";
  return option.takes_value() ? " -x" : "";
}

}  // namespace

std::string zsh_completion(const CommandTree& tree) {
  std::string verbs, arguments;
  for (const CommandVerb& verb : tree.verbs) {
    verbs += "\n        " + zsh_quoted(verb.name + ":" + verb.summary);
    arguments += fmt::format("        {}) _arguments{} ;;\n", verb.name, zsh_arguments(verb.options));
  }
  return fmt::format(fmt::runtime(zsh_script), zsh_arguments(tree.options), verbs, arguments);
}

std::string fish_completion(const CommandTree& tree) {
  std::string text =
      "# Completion of peclet for fish. Use it with: peclet completion fish | source\n"
      "complete -c peclet -f\n";
  for (const CommandOption& option : tree.options) {
    text += fmt::format("complete -c peclet -n __fish_use_subcommand -l {} -d {}\n", option.name.substr(2),
                        fish_quoted(option.meaning));
  }
  for (const CommandVerb& verb : tree.verbs) {
    text += fmt::format("complete -c peclet -n __fish_use_subcommand -a {} -d {}\n", verb.name,
                        fish_quoted(verb.summary));
    const std::string where = fish_quoted("__fish_seen_subcommand_from " + verb.name);
    for (const CommandOption& option : verb.options) {
      const std::string value = fish_value(option);
      if (!option.positional) {
        text += fmt::format("complete -c peclet -n {} -l {}{} -d {}\n", where, option.name.substr(2), value,
                            fish_quoted(option.meaning));
      } else if (value != " -x") {
        // Words without a name are completed wherever they stand.
        text += fmt::format("complete -c peclet -n {}{}\n", where, value);
      }
    }
  }
  return text;
}

std::string completion(const CommandTree& tree, const std::string& shell) {
  if (shell == "bash") return bash_completion(tree);
  if (shell == "zsh") return zsh_completion(tree);
  assert(shell == "fish");
  return fish_completion(tree);
}

}  // namespace peclet::runner
