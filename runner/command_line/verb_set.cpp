#include "runner/command_line/verb_set.h"

#include <charconv>
#include <cmath>
#include <system_error>

#include "contract/input_error.h"

namespace peclet::runner {
namespace {

// The word spelt anew for the parser, which would take 010 for 8 and 1e3 for no integer. What is at most 1
// may be given in per cent. Throws InputError at the option's name.
std::string checked(const std::string& name, const std::string& word, const Key& allowed) {
  double number = 0;
  const bool in_percent = allowed.maximum <= 1 && word.ends_with('%');
  const std::size_t digits = in_percent ? word.find_last_not_of(' ', word.size() - 2) + 1 : word.size();
  const char* const end = word.data() + digits;
  const auto [stop, error] = std::from_chars(word.data(), end, number);
  if (in_percent) number /= 100;
  if (error != std::errc{} || stop != end || !std::isfinite(number)) {
    throw InputError("", name, word, allowed_values(allowed));
  }
  try {
    return KeyTable("", {allowed}).validate(number, "").dump();
  } catch (const InputError& fault) {
    // How per cent are written, after a semicolon, is no news for somebody who has written them.
    throw InputError("", name, word,
                     in_percent ? fault.allowed().substr(0, fault.allowed().find(';')) : fault.allowed());
  }
}

// What a script leaves when its variable is not set.
std::string named_file(const std::string& word) {
  if (word.empty()) throw InputError("", "campaign", "\"\"", "must be the name of a file");
  return "";
}

}  // namespace

CLI::App* VerbSet::add(const char* name, const char* description, const char* example, const VerbPage& page) {
  CLI::App* const verb = app_.add_subcommand(name, description);
  verb->footer(help_footer(page, example));
  return verb;
}

void add_file(CLI::App* verb, std::filesystem::path& path) {
  verb->add_option("campaign", path, "Campaign file (JSON)")
      ->required()
      ->check(CLI::Validator(named_file, ""))
      ->type_name(value_name::campaign_file);
}

void add_file_or_folder(CLI::App* verb, std::filesystem::path& path) {
  verb->add_option("campaign", path, "Campaign file, or its .peclet folder")
      ->required()
      ->check(CLI::Validator(named_file, ""))
      ->type_name(value_name::campaign);
}

void add_directory(CLI::App* verb, std::filesystem::path& path) {
  verb->add_option("--directory", path,
                   "Folder of the campaign's database and checkpoints; NAME.peclet beside "
                   "NAME.json unless given")
      ->type_name(value_name::folder);
}

void add_accept_engine(CLI::App* verb, std::string& name) {
  verb->add_option("--accept-engine", name,
                   "Version, or 6 or more digits of the hash, of the engine that is there now: results of "
                   "another one at open points are kept apart");
}

void add_seconds(CLI::App* verb, const char* name, double& seconds, const char* meaning) {
  add_number(verb, name, seconds, number_above(0), meaning)->type_name("SECONDS")->capture_default_str();
}

Key whole_number(double minimum, double maximum) {
  return {.pointer = "", .kind = KeyKind::integer, .meaning = "", .minimum = minimum, .maximum = maximum};
}

Key number_from(double minimum, double maximum) {
  return {.pointer = "", .kind = KeyKind::number, .meaning = "", .minimum = minimum, .maximum = maximum};
}

Key number_above(double minimum) {
  Key key = number_from(minimum);
  key.above_minimum = true;
  return key;
}

void check_number(CLI::Option* option, const Key& allowed) {
  Key whole = allowed;
  whole.pointer = "";  // the word is all of the document
  const auto check = [name = option->get_name(), whole](std::string& word) {
    if (!word.empty()) word = checked(name, word, whole);  // empty: an option whose value may be left out
    return std::string();
  };
  option->transform(CLI::Validator(check, ""));
}

}  // namespace peclet::runner
