// Verbs that are about no campaign.
#include <memory>

#include "runner/command_line/verb_set.h"

namespace peclet::runner {
namespace {

void add_study(VerbSet& verbs) {
  const auto options = std::make_shared<StudyOptions>();
  CLI::App* const verb = verbs.add("study", "List the studies of published statements, or make one again",
                                   "peclet study pair-potential --quick");
  CLI::Option* const name =
      verb->add_option("study", options->name, "Which; the list unless given")->type_name("STUDY");
  verb->add_flag("--list", options->list, "List them with their verdicts, as without a name")->excludes(name);
  verb->add_flag("--quick", options->quick, "Half a minute of it, which fails where the physics is broken")
      ->needs(name);
  verb->add_flag("--long", options->with_long,
                 "Also the points that take hours, where the study has such; best with --folder")
      ->needs(name)
      ->excludes("--quick");
  add_number(verb, "--times", options->times, whole_number(1, 1000),
             "So many times as many seeds, for error bars smaller by the root of it; best with --folder")
      ->type_name("NUMBER")
      ->needs(name)
      ->excludes("--quick");
  verb->add_flag("--json", options->json, "The list, for programs")->excludes(name);
  verb->add_option(
          "--folder", options->folder,
          "Folder of the study's campaigns, with which a second call goes on; a temporary one unless "
          "given")
      ->type_name(value_name::folder)
      ->needs(name);
  verb->add_option("--results", options->results,
                   "Folder of the studies; those that came with peclet unless given")
      ->type_name(value_name::folder);
  verbs.choose(verb, options);
}

void add_completion(VerbSet& verbs) {
  const auto options = std::make_shared<CompletionOptions>();
  CLI::App* const verb =
      verbs.add("completion", "Print a script with which a shell completes verbs, options and files",
                "eval \"$(peclet completion bash)\"");
  verb->add_option("shell", options->shell, "The shell")
      ->required()
      ->type_name("SHELL")
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  verb->add_option("--output", options->output,
                   "File to write, whole or not at all; standard output unless given")
      ->type_name(value_name::file);
  verb->add_flag("--quiet", options->quiet, "Do not say on stderr where it was written");
  verbs.choose(verb, options);
}

void add_manual(VerbSet& verbs) {
  const auto options = std::make_shared<ManualOptions>();
  CLI::App* const verb =
      verbs.add("manual", "Print a page of the manual for man(1)", "peclet manual run | man -l -");
  CLI::Option* const name =
      verb->add_option("verb", options->verb, "Which; that of peclet itself unless given")->type_name("VERB");
  verb->add_option("--folder", options->folder, "Folder to write all pages to")
      ->type_name(value_name::folder)
      ->check(CLI::ExistingDirectory)
      ->excludes(name);
  verbs.choose(verb, options);
}

}  // namespace

void add_other_verbs(VerbSet& verbs) {
  add_study(verbs);
  add_completion(verbs);
  add_manual(verbs);
}

}  // namespace peclet::runner
