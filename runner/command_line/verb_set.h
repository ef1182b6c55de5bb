// What the functions that add verbs to the command line share. A verb is one such function: its options, what
// is said of it, and what it does.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "contract/key_table.h"
#include "runner/command_line/command_tree.h"

namespace peclet::runner {

// What --help, and so the manual, says of verbs beyond the one line that the list of verbs has.
struct VerbExample {
  std::string command;
  std::string purpose;  // may be empty
};

struct VerbPage {
  std::vector<std::string> paragraphs;
  std::vector<VerbExample> examples;  // after the one that the verb itself has
  std::vector<int> exit_codes;        // that it can leave with; empty: any
};

// Paragraphs of `prose` are separated by empty lines; where its lines end means nothing.
VerbPage page(const std::string& prose, std::vector<VerbExample> examples, std::vector<int> exit_codes);

// A line for each of these exit codes, below a heading; for all of them if there are none.
std::string exit_code_lines(const std::vector<int>& codes);

// What follows the options in --help.
std::string help_footer(const VerbPage& page, const std::string& example);

// The parser, and the verb that was named once it has parsed.
class VerbSet {
 public:
  VerbSet() = default;
  VerbSet(const VerbSet&) = delete;
  VerbSet& operator=(const VerbSet&) = delete;

  CLI::App& app() { return app_; }
  const CLI::App& app() const { return app_; }
  // What the verb that was named does; it gives an exit code. Nothing before the parser has parsed.
  const std::function<int()>& action() const { return action_; }

  CLI::App* add(const char* name, const char* description, const char* example, const VerbPage& page);

  // `perform`, a function of the options into which the parser writes, is the action when the verb is the one
  // that was named. It gives an exit code, or nothing for 0.
  template <typename Options, typename Perform>
  void choose(CLI::App* verb, const std::shared_ptr<Options>& options, Perform perform) {
    verb->callback([this, options, perform] {
      action_ = [options, perform] {
        if constexpr (std::is_void_v<std::invoke_result_t<Perform, const Options&>>) {
          perform(*options);
          return 0;
        } else {
          return perform(*options);
        }
      };
    });
  }

 private:
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
void add_other_verbs(VerbSet& verbs);

// Options that several verbs have.
void add_file(CLI::App* verb, std::filesystem::path& path);
void add_file_or_folder(CLI::App* verb, std::filesystem::path& path);
void add_directory(CLI::App* verb, std::filesystem::path& path);
void add_accept_engine(CLI::App* verb, std::string& name);
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
