// What the functions that add verbs to the command line share. A verb is one such function: its options, what
// is said of it, and what it does.
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "contract/key_table.h"
#include "runner/command_line/print.h"

namespace peclet::runner {

// A line for each of these exit codes, below a heading; for all of them if there are none.
std::string exit_code_lines(const std::vector<int>& codes);

// The parser, and the verb that was named once it has parsed.
class VerbSet {
 public:
  VerbSet() = default;
  VerbSet(const VerbSet&) = delete;
  VerbSet& operator=(const VerbSet&) = delete;

  CLI::App& app() { return app_; }
  // What the verb that was named does; it gives an exit code. Nothing before the parser has parsed.
  const std::function<int()>& action() const { return action_; }

  // Adds a verb that can leave with these exit codes, and returns it with the options into which the parser
  // writes. `perform`, a function of them, is the action when the verb is the one that was named. It gives
  // nothing, an exit code, what is to be printed, or both as `text` and `exit_code`.
  //
  // `page` is what --help, and so the manual, says of the verb beyond its line in the list of verbs:
  // paragraphs that are separated by empty lines, where ends of lines mean nothing, and examples as they are
  // printed, in lines that begin with two blanks.
  template <typename Options, typename Perform>
  std::pair<CLI::App*, Options*> add(Perform perform, const char* name, const char* description,
                                     const std::vector<int>& exit_codes, const char* page) {
    CLI::App* const verb = add(name, description, exit_codes, page);
    const auto options = std::make_shared<Options>();
    verb->callback([this, options, perform] {
      action_ = [options, perform] {
        using Answer = std::invoke_result_t<Perform, const Options&>;
        if constexpr (std::is_void_v<Answer>) {
          perform(*options);
          return 0;
        } else {
          return conclude(perform(*options));
        }
      };
    });
    return {verb, options.get()};
  }

 private:
  static int conclude(int exit_code) { return exit_code; }
  static int conclude(const std::string& text) {
    print(text);
    return 0;
  }
  static int conclude(const auto& answer) {
    print(answer.text);
    return answer.exit_code;
  }

  CLI::App* add(const char* name, const char* description, const std::vector<int>& exit_codes,
                const char* page);

  CLI::App app_{"Campaigns of dense-suspension simulations: from a scene to converged averages", "peclet"};
  std::function<int()> action_;
};

// One function a verb, in the file of its group. In the order in which help lists them.
void add_running_verbs(VerbSet& verbs);
void add_viewing_verbs(VerbSet& verbs);
void add_changing_verbs(VerbSet& verbs);

// Options that several verbs have.
void add_file(CLI::App* verb, std::filesystem::path& path, const char* shown = "campaign FILE.json",
              const char* meaning = "Campaign file (JSON)");
void add_directory(CLI::App* verb, std::filesystem::path& path);
CLI::Option* add_output(CLI::App* verb, std::filesystem::path& path);
CLI::Option* add_json(CLI::App* verb, bool& json);
// Does not say where --output was written.
void add_quiet(CLI::App* verb, bool& quiet);
void add_accept_engine(CLI::App* verb, std::string& name);
// A campaign that is named by its file, or also by its folder, with --directory.
template <typename Options>
void add_campaign_file(CLI::App* verb, Options& options) {
  add_file(verb, options.campaign);
  add_directory(verb, options.directory);
}
template <typename Options>
void add_campaign(CLI::App* verb, Options& options) {
  add_file(verb, options.campaign, "campaign CAMPAIGN", "Campaign file, or its .peclet folder");
  add_directory(verb, options.directory);
}
// A time > 0, which has a default.
void add_seconds(CLI::App* verb, const char* name, double& seconds, const char* meaning);

// What a number may be. Without a maximum of its own it is bounded by 1e9, so that times can be counted in
// nanoseconds: 31 years of seconds.
Key whole_number(double minimum, double maximum);
Key number_above(double minimum);
Key number_from(double minimum, double maximum = 1e9);

// Adds an option as help shows it: "--output FILE" is its name and what its value is called.
template <typename Value>
CLI::Option* add_option(CLI::App* verb, const std::string& shown, Value& value, const char* meaning) {
  const std::size_t blank = std::min(shown.find(' '), shown.size());
  CLI::Option* const option = verb->add_option(shown.substr(0, blank), value, meaning);
  return blank < shown.size() ? option->type_name(shown.substr(blank + 1)) : option;
}

// The only reader of numbers of the command line: finite, in range, all of the word.
// `value` is an int or a double, one of these that may be absent, or a list of them.
// The parser throws InputError at the option's name for anything else.
void check_number(CLI::Option* option, const Key& allowed);

template <typename Value>
CLI::Option* add_number(CLI::App* verb, const std::string& shown, Value& value, const Key& allowed,
                        const char* meaning) {
  CLI::Option* const option = add_option(verb, shown, value, meaning);
  check_number(option, allowed);
  return option;
}

// What is read off the verbs and options themselves, so that it cannot say anything else.

// Prints values without the parser's own words for their checks: "--threads NUMBER=1".
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option_opts(const CLI::Option* option) const override;
};

// Returns a script of bash for `eval`, or for a file in bash's own folder of completions. It offers verbs,
// options, choices, and files where a value is called so: FILE.json (campaign files), CAMPAIGN (those and
// .peclet folders), FILE and FOLDER.
std::string bash_completion(const CLI::App& app);

}  // namespace peclet::runner
