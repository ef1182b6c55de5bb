// What the functions that add verbs to the command line share. A verb is one such function: its options, what
// is said of it, and what it does.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "contract/key_table.h"
#include "runner/command_line/completion.h"
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
void add_looking_verbs(VerbSet& verbs);
void add_drawing_verbs(VerbSet& verbs);
void add_estimating_verbs(VerbSet& verbs);
void add_changing_verbs(VerbSet& verbs);
void add_batch_verbs(VerbSet& verbs);
void add_keeping_verbs(VerbSet& verbs);

// Options that several verbs have.
void add_file(CLI::App* verb, std::filesystem::path& path);
void add_directory(CLI::App* verb, std::filesystem::path& path);
CLI::Option* add_output(CLI::App* verb, std::filesystem::path& path);
void add_file_or_folder(CLI::App* verb, std::filesystem::path& path);
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
  add_file_or_folder(verb, options.campaign);
  add_directory(verb, options.directory);
}
// A time > 0, which has a default.
void add_seconds(CLI::App* verb, const char* name, double& seconds, const char* meaning);

// What a number may be. Without a maximum of its own it is bounded by 1e9, so that times can be counted in
// nanoseconds: 31 years of seconds.
Key whole_number(double minimum, double maximum);
Key number_above(double minimum);
Key number_from(double minimum, double maximum = 1e9);

// The only reader of numbers of the command line: finite, in range, all of the word.
// `value` is an int or a double, one of these that may be absent, or a list of them.
// The parser throws InputError at the option's name for anything else.
void check_number(CLI::Option* option, const Key& allowed);

template <typename Value>
CLI::Option* add_number(CLI::App* verb, const char* name, Value& value, const Key& allowed,
                        const char* meaning) {
  CLI::Option* const option = verb->add_option(name, value, meaning);
  check_number(option, allowed);
  return option;
}

}  // namespace peclet::runner
