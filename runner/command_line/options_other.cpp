// Verbs that are about no campaign.
#include <memory>

#include "contract/output_file.h"
#include "runner/command_line/completion.h"
#include "runner/command_line/manual.h"
#include "runner/command_line/print.h"
#include "runner/command_line/verb_set.h"

namespace peclet::runner {
namespace {

void write_completion(const CompletionOptions& options) {
  deliver(completion(command_tree(), options.shell), options.output, options.quiet);
}

void add_completion(VerbSet& verbs) {
  const auto options = std::make_shared<CompletionOptions>();
  CLI::App* const verb = verbs.add(
      "completion", "Print a script with which a shell completes verbs, options and files",
      "eval \"$(peclet completion bash)\"",
      page(R"(
For bash and zsh, put the line of the example (with the name of the shell) into ~/.bashrc or ~/.zshrc;
for fish, write the script to ~/.config/fish/completions/peclet.fish. `cmake --install` puts all three
where the shells find them by themselves.
)",
           {{"peclet completion fish --output ~/.config/fish/completions/peclet.fish", ""}}, {0, 1, 2}));
  verb->add_option("shell", options->shell, "The shell")
      ->required()
      ->type_name("SHELL")
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  verb->add_option("--output", options->output,
                   "File to write, whole or not at all; standard output unless given")
      ->type_name(value_name::file);
  verb->add_flag("--quiet", options->quiet, "Do not say on stderr where it was written");
  verbs.choose(verb, options, write_completion);
}

void write_manual(const ManualOptions& options) {
  if (options.folder.empty()) {
    print(manual_page(command_tree(), options.verb));
    return;
  }
  for (const auto& [name, page] : manual_pages(command_tree())) write_output(options.folder / name, page);
}

void add_manual(VerbSet& verbs) {
  const auto options = std::make_shared<ManualOptions>();
  CLI::App* const verb = verbs.add(
      "manual", "Print a page of the manual for man(1)", "peclet manual run | man -l -",
      page(R"(
The pages are made of the same verbs and options as --help. `cmake --install` puts them where man(1)
finds them.
)",
           {{"peclet manual --folder ~/.local/share/man/man1", "then `man peclet-run`"}}, {0, 1, 2}));
  CLI::Option* const name =
      verb->add_option("verb", options->verb, "Which; that of peclet itself unless given")->type_name("VERB");
  verb->add_option("--folder", options->folder, "Folder to write all pages to")
      ->type_name(value_name::folder)
      ->check(CLI::ExistingDirectory)
      ->excludes(name);
  verbs.choose(verb, options, write_manual);
}

}  // namespace

void add_other_verbs(VerbSet& verbs) {
  add_completion(verbs);
  add_manual(verbs);
}

}  // namespace peclet::runner
