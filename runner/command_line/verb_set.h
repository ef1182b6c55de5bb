// The parts that the verbs of the command line share. One function adds each verb: options, help and action.
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

// Returns a heading and a line for each of these exit codes; for all exit codes if `codes` is empty.
std::string exit_code_lines(const std::vector<int>& codes);

// The parser of the command line, and the action of the verb that it has read.
class VerbSet {
 public:
  VerbSet() = default;
  VerbSet(const VerbSet&) = delete;
  VerbSet& operator=(const VerbSet&) = delete;

  CLI::App& app() { return app_; }
  // The action of the verb that was named; it returns an exit code. Empty before the parser has parsed.
  const std::function<int()>& action() const { return action_; }

  // Adds a verb that can leave with these exit codes. Returns it with its options, into which the parser
  // writes. If the verb is named, the action is `perform(options)`. That returns nothing, an exit code, a
  // text to print, or an object with both as `text` and `exit_code`.
  //
  // `page` is the text of --help and of the manual page. Paragraphs are separated by empty lines, and their
  // lines are broken anew. Lines that begin with two blanks are examples, printed as they are.
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

// Add the verbs of a group, in the order in which help lists them.
void add_running_verbs(VerbSet& verbs);
void add_viewing_verbs(VerbSet& verbs);
void add_curve_verbs(VerbSet& verbs);
void add_changing_verbs(VerbSet& verbs);

void add_file(CLI::App* verb, std::filesystem::path& path, const char* shown = "campaign FILE.json",
              const char* meaning = "Campaign file (JSON)");
void add_directory(CLI::App* verb, std::filesystem::path& path);
CLI::Option* add_output(CLI::App* verb, std::filesystem::path& path);
CLI::Option* add_json(CLI::App* verb, bool& json);
// Adds --quiet, which leaves out the message about where --output was written.
void add_quiet(CLI::App* verb, bool& quiet);
void add_accept_engine(CLI::App* verb, std::string& name);
// Add --directory and the campaign, which is named by its file; with add_campaign() also by its folder.
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
// Adds a time > 0 [s] whose default is the present value of `seconds`.
void add_seconds(CLI::App* verb, const char* name, double& seconds, const char* meaning);

// Return the allowed values of a number, by default at most 1e9, so that nanoseconds can count the seconds.
Key whole_number(double minimum, double maximum);
Key number_above(double minimum);
Key number_from(double minimum, double maximum = 1e9);

// Adds an option. `shown` is its name and, behind a blank, the name of its value: "--output FILE".
template <typename Value>
CLI::Option* add_option(CLI::App* verb, const std::string& shown, Value& value, const char* meaning) {
  const std::size_t blank = std::min(shown.find(' '), shown.size());
  CLI::Option* const option = verb->add_option(shown.substr(0, blank), value, meaning);
  return blank < shown.size() ? option->type_name(shown.substr(blank + 1)) : option;
}

// Makes the parser accept only a finite number in the allowed range that takes the whole word. For anything
// else the parser throws InputError at the option's name. All numbers of the command line are read this way.
void check_number(CLI::Option* option, const Key& allowed);

// Adds an option whose `value` is an int or a double, an optional one, or a list of them.
template <typename Value>
CLI::Option* add_number(CLI::App* verb, const std::string& shown, Value& value, const Key& allowed,
                        const char* meaning) {
  CLI::Option* const option = add_option(verb, shown, value, meaning);
  check_number(option, allowed);
  return option;
}

// Prints the value of an option without the parser's own words for its check: "--threads NUMBER=1".
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option_opts(const CLI::Option* option) const override;
};

// Returns a bash script for `eval`, or for a file in bash's folder of completions. It offers verbs, options
// and choices. It offers files for values that are called FILE.json (campaign files), CAMPAIGN (those and
// .peclet folders), FILE or FOLDER.
std::string bash_completion(const CLI::App& app);

}  // namespace peclet::runner
