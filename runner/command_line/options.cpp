#include "runner/command_line/options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "contract/errors.h"
#include "contract/provenance.h"
#include "contract/usage_fault.h"
#include "runner/command_line/command_tree.h"
#include "runner/command_line/print.h"
#include "runner/command_line/verb_set.h"

namespace peclet::runner {
namespace {

std::string version_text() {
  const Json& origin = provenance();
  return fmt::format("peclet {} (commit {}{})", version(), origin.value("git_commit", "unknown"),
                     origin.value("git_dirty", Json()) == true ? ", with changes" : "");
}

std::string footer() { return exit_code_lines({}) + "`peclet help VERB` says more about a verb."; }

// The command line as it was typed, and what to say where it has a fault.
class Reader {
 public:
  Reader() {
    CLI::App& app = verbs_.app();
    app.require_subcommand(1);
    app.set_version_flag("--version", std::function<std::string()>(version_text));  // reads the program file
    app.footer(footer());
    app.formatter(std::make_shared<HelpFormatter>());
    add_running_verbs(verbs_);
    add_looking_verbs(verbs_);
    add_drawing_verbs(verbs_);
    add_estimating_verbs(verbs_);
    add_changing_verbs(verbs_);
    add_batch_verbs(verbs_);
    add_keeping_verbs(verbs_);
    add_other_verbs(verbs_);
  }

  CommandLine read(const std::vector<std::string>& words) {
    try {
      std::vector<std::string> reversed(words.rbegin(), words.rend());  // as the parser wants them
      verbs_.app().parse(reversed);
    } catch (const CLI::ParseError& end) {
      const bool is_known =
          words.empty() || words.front().starts_with("-") || verb_called(verbs_.app(), words) != nullptr;
      if (end.get_exit_code() == 0 && is_known) return {nullptr, verbs_.app().exit(end)};  // help or version
      return complain(usage_fault(verbs_.app(), words, end));
    } catch (const InputError& fault) {
      return complain(fmt::format("{}: {}", words.front(), fault.what()));
    }
    return {verbs_.action(), 0};
  }

  CommandTree tree() const { return describe(verbs_.app()); }

 private:
  static CommandLine complain(const std::string& fault) {
    fmt::print(stderr, "peclet: {}\n", fault);
    return {nullptr, ExitCode::usage};
  }

  VerbSet verbs_;
};

}  // namespace

CommandLine read_command_line(int argc, char** argv) {
  std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  if (words == std::vector<std::string>{"version"}) words.front() = "--version";
  if (!words.empty() && words.front() == "help") {  // `peclet help run` is `peclet run --help`
    words.erase(words.begin());
    words.insert(words.begin() + std::min<std::ptrdiff_t>(1, std::ssize(words)), "--help");
  }
  return Reader().read(words);
}

CommandTree command_tree() { return Reader().tree(); }

// Verbs that are about no campaign.

namespace {

void write_completion(const CompletionOptions& options) {
  deliver(bash_completion(command_tree()), options.output, options.quiet);
}

void add_completion(VerbSet& verbs) {
  const auto options = std::make_shared<CompletionOptions>();
  CLI::App* const verb =
      verbs.add("completion", "Print a script with which bash completes verbs, options and files",
                "eval \"$(peclet completion bash)\"",
                page(R"(
Put the line of the example into ~/.bashrc. `cmake --install` puts the script where bash finds it by itself.
)",
                     {}, {0, 1, 2}));
  verb->add_option("shell", options->shell, "The shell")
      ->required()
      ->type_name("SHELL")
      ->check(CLI::IsMember({"bash"}));
  verb->add_option("--output", options->output,
                   "File to write, whole or not at all; standard output unless given")
      ->type_name(value_name::file);
  verb->add_flag("--quiet", options->quiet, "Do not say on stderr where it was written");
  verbs.choose(verb, options, write_completion);
}

}  // namespace

void add_other_verbs(VerbSet& verbs) { add_completion(verbs); }

}  // namespace peclet::runner
