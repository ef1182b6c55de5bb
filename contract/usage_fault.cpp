#include "contract/usage_fault.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <string_view>
#include <utility>

#include "contract/text.h"

namespace peclet {
namespace {

constexpr std::size_t longest_word = 60, longest_reason = 300;

std::vector<std::string> verb_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* verb : app.get_subcommands(std::function<bool(const CLI::App*)>()))
    names.push_back(verb->get_name());
  return names;
}

std::vector<std::string> option_names(const CLI::App& verb) {
  std::vector<std::string> names;
  for (const CLI::Option* option : verb.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

// Returns true if the word begins as an option does; "-1" is a number.
bool looks_like_option(const std::string& word) {
  return word.size() > 1 && word.front() == '-' && (word[1] < '0' || word[1] > '9') && word[1] != '.';
}

// Returns the first word that looks like an option and is not one of the verb's, or "".
std::string unknown_option(const CLI::App& verb, const std::vector<std::string>& words) {
  bool is_value = false;
  for (const std::string& word : words) {
    const std::string name = word.substr(0, word.find('='));
    if (name == "--") return "";  // ends the options
    if (std::exchange(is_value, false) || !looks_like_option(name)) continue;
    const CLI::Option* const known =
        verb.get_option_no_throw(name.starts_with("--") ? name : name.substr(0, 2));
    if (known == nullptr) return name;
    is_value = name == word && known->get_items_expected_max() > 0;
  }
  return "";
}

// Returns a suggestion for an unknown option. A short option may stand for one of that first letter, and -j,
// as in make, for --workers.
std::string meant_by(const std::string& unknown, const std::vector<std::string>& names) {
  if (unknown.starts_with("--")) return suggestion(unknown, names);
  const char letter = unknown[1] == 'j' ? 'w' : unknown[1];
  const auto begins = [&](const std::string& name) { return name[2] == letter; };
  const auto found = std::find_if(names.begin(), names.end(), begins);
  const bool is_only_one = std::count_if(names.begin(), names.end(), begins) == 1;
  return is_only_one ? "; did you mean " + *found + "?" : "";
}

// Returns the text before `mark`: the name of the option in the parser's messages.
std::string before(const std::string& said, std::string_view mark) { return said.substr(0, said.find(mark)); }

std::string after(const std::string& said, std::string_view mark) {
  const std::size_t found = said.find(mark);
  return found == std::string::npos ? said : said.substr(found + mark.size());
}

std::string missing(const CLI::App& verb, const std::string& name) {
  for (const CLI::Option* option : verb.get_options()) {
    if (option->get_name() == name) return fmt::format("{}: is missing: {}", name, option->get_description());
  }
  return name + ": is missing";
}

std::string superfluous(const std::string& word) {
  return word.starts_with("-") ? word + ": there is no such option" : word + ": is one word too many";
}

// Returns what is wrong, by the parser's class of fault; for other classes the parser's text.
std::string reason(const CLI::App& verb, const CLI::ParseError& fault) {
  std::string said = fault.what();
  if (dynamic_cast<const CLI::RequiredError*>(&fault) != nullptr)
    return missing(verb, before(said, " is required"));
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&fault) != nullptr)
    return before(before(said, ":"), " was given") + ": must have one value";
  if (dynamic_cast<const CLI::ExtrasError*>(&fault) != nullptr) return superfluous(after(said, "expected: "));
  if (dynamic_cast<const CLI::ExcludesError*>(&fault) != nullptr)
    return fmt::format("{}: cannot stand beside {}", before(said, " excludes "), after(said, " excludes "));
  if (dynamic_cast<const CLI::RequiresError*>(&fault) != nullptr)
    return fmt::format("{}: needs {}", before(said, " requires "), after(said, " requires "));
  if (dynamic_cast<const CLI::ConversionError*>(&fault) != nullptr)
    return before(after(said, "Could not convert: "), " = ") + ": has a value of the wrong kind";
  return said;
}

}  // namespace

const CLI::App* verb_called(const CLI::App& app, const std::vector<std::string>& words) {
  if (words.empty()) return nullptr;
  const auto has_name = [&](const CLI::App* verb) { return verb->get_name() == words.front(); };
  const std::vector<const CLI::App*> found = app.get_subcommands(has_name);
  return found.empty() ? nullptr : found.front();
}

std::string usage_fault(const CLI::App& app, const std::vector<std::string>& words,
                        const CLI::ParseError& fault) {
  const CLI::App* const verb = verb_called(app, words);
  const std::string& program = app.get_name();
  if (verb == nullptr) {
    if (words.empty()) return fmt::format("a verb is missing; `{} --help` lists them", program);
    const std::string first = printable(words.front(), longest_word);
    const bool verb_is_second = words.size() > 1 && verb_called(app, {words[1]}) != nullptr;
    if (verb_is_second) return fmt::format("{0}: the verb goes first: {1} {2} {0}", first, program, words[1]);
    return fmt::format("{}: there is no such {}; `{} --help` lists them{}", first,
                       words.front().starts_with("-") ? "option" : "verb", program,
                       suggestion(words.front(), verb_names(app)));
  }
  if (const std::string unknown = unknown_option(*verb, words); !unknown.empty()) {
    return fmt::format("{0}: {1}: there is no such option; `{3} {0} --help` lists them{2}", verb->get_name(),
                       printable(unknown, longest_word), meant_by(unknown, option_names(*verb)), program);
  }
  return fmt::format("{0}: {1}; `{2} {0} --help` says more", verb->get_name(),
                     printable(reason(*verb, fault), longest_reason), program);
}

}  // namespace peclet
