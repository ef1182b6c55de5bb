#include "runner/command_line/verb_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <system_error>

#include "contract/decimal.h"
#include "contract/errors.h"

namespace peclet::runner {
namespace {

constexpr std::size_t help_width = 100;

// Returns the words of the text in lines of at most `help_width` characters.
std::string wrapped(const std::string& text) {
  std::istringstream words(text);
  std::string lines;
  std::size_t used = 0;
  for (std::string word; words >> word;) {
    const bool breaks = used > 0 && used + 1 + word.size() > help_width;
    if (used > 0) lines += breaks ? '\n' : ' ';
    used = (used == 0 || breaks ? 0 : used + 1) + word.size();
    lines += word;
  }
  return lines + '\n';
}

}  // namespace

std::string exit_code_lines(const std::vector<int>& codes) {
  static const std::map<int, std::string> meanings{
      {ExitCode::done, "done; for a run: every point has converged, or has all its seeds"},
      {ExitCode::error, "error"},
      {ExitCode::usage, "usage, or faulty input; nothing has been written"},
      {ExitCode::unconverged, "finished, but some points are capped, failed, cancelled or lost seeds"},
      {ExitCode::unfinished,
       "not finished yet; for set, cancel and retry: requested, but not carried out yet"},
      {ExitCode::owned, "another process owns the campaign"},
      {ExitCode::integrity, "integrity: the database is damaged, or a seed gave two different results"},
      {ExitCode::stopped,
       "stopped by a signal or a time limit, or at the end of its budget; the same command resumes"}};
  std::string text = "Exit codes:\n";
  for (const auto& [code, meaning] : meanings) {
    if (codes.empty() || std::count(codes.begin(), codes.end(), code) > 0)
      text += fmt::format("  {:>2}  {}\n", code, meaning);
  }
  return text;
}

namespace {

// Returns the text of --help behind the options: paragraphs, exit codes and examples.
std::string help_footer(const std::string& page, const std::vector<int>& exit_codes) {
  std::istringstream lines(page);
  std::string text, paragraph, examples;
  int commands = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("  ")) {
      examples += '\n' + line;
      commands += line[2] != ' ' && line[2] != '#' ? 1 : 0;
    } else if (line.empty() && !paragraph.empty()) {
      text += wrapped(std::exchange(paragraph, "")) + '\n';
    } else {
      paragraph += line + ' ';
    }
  }
  return text + exit_code_lines(exit_codes) + (commands > 1 ? "\nExamples:" : "\nExample:") + examples;
}

// Returns the number in the spelling that the parser reads correctly; it would read 010 as 8, and refuse 1e3
// as an integer. A number that is at most 1 may be given in per cent. Throws InputError at the option's name.
std::string checked(const std::string& name, const std::string& word, const Key& allowed) {
  double number = 0;
  const bool in_percent = allowed.maximum <= 1 && word.ends_with('%');
  const std::size_t digits = in_percent ? word.find_last_not_of(' ', word.size() - 2) + 1 : word.size();
  const char* const end = word.data() + digits;
  const auto [stop, error] = read_double(word.data(), end, number);
  if (in_percent) number /= 100;
  if (error != std::errc{} || stop != end) {
    throw InputError("", name, word, allowed_values(allowed));
  }
  try {
    return KeyTable("", {allowed}).validate(number, "").dump();
  } catch (const InputError& fault) {
    // The hint behind the semicolon tells how to write per cent, which the user has done already.
    throw InputError("", name, word,
                     in_percent ? fault.allowed().substr(0, fault.allowed().find(';')) : fault.allowed());
  }
}

// Refuses an empty name, which a script passes if its variable is not set.
std::string named_file(const std::string& word) {
  if (word.empty()) throw InputError("", "campaign", "\"\"", "must be the name of a file");
  return "";
}

}  // namespace

CLI::App* VerbSet::add(const char* name, const char* description, const std::vector<int>& exit_codes,
                       const char* page) {
  CLI::App* const verb = app_.add_subcommand(name, description);
  verb->footer(help_footer(page, exit_codes));
  return verb;
}

void add_file(CLI::App* verb, std::filesystem::path& path, const char* shown, const char* meaning) {
  add_option(verb, shown, path, meaning)->required()->check(CLI::Validator(named_file, ""));
}

void add_directory(CLI::App* verb, std::filesystem::path& path) {
  add_option(verb, "--directory FOLDER", path,
             "Folder of the campaign's database and checkpoints; NAME.peclet beside NAME.json unless given");
}

CLI::Option* add_output(CLI::App* verb, std::filesystem::path& path) {
  return add_option(verb, "--output FILE", path,
                    "File to write, whole or not at all; standard output unless given");
}

CLI::Option* add_json(CLI::App* verb, bool& json) {
  return verb->add_flag("--json", json, "Print JSON, for programs");
}

void add_quiet(CLI::App* verb, bool& quiet) {
  verb->add_flag("--quiet", quiet, "Do not say on stderr where the output was written");
}

void add_accept_engine(CLI::App* verb, std::string& name) {
  add_option(verb, "--accept-engine", name,
             "Version of the present engine, or 6 or more digits of its hash: results of other engines at "
             "open points are set aside");
}

void add_seconds(CLI::App* verb, const char* name, double& seconds, const char* meaning) {
  add_number(verb, std::string(name) + " SECONDS", seconds, number_above(0), meaning)->capture_default_str();
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
  whole.pointer = "";  // the word is the whole document
  const auto check = [name = option->get_name(), whole](std::string& word) {
    if (!word.empty()) word = checked(name, word, whole);  // empty: an option whose value may be left out
    return std::string();
  };
  option->transform(CLI::Validator(check, ""));
}

}  // namespace peclet::runner
