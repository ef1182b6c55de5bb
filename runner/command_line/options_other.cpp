// Verbs that are about no campaign.
#include <memory>

#include "runner/command_line/completion.h"
#include "runner/command_line/print.h"
#include "runner/command_line/verb_set.h"

namespace peclet::runner {
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
