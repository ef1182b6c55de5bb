// Verbs that are about no campaign.
#include <memory>

#include "runner/command_line/completion.h"
#include "runner/command_line/print.h"
#include "runner/command_line/verb_set.h"
#include "runner/verbs/study.h"

namespace peclet::runner {
namespace {

void add_study(VerbSet& verbs) {
  const auto options = std::make_shared<StudyOptions>();
  CLI::App* const verb = verbs.add(
      "study", "List the studies of published statements, or make one again",
      "peclet study pair-potential --quick",
      page(R"(
A study remakes published figures with error bars and answers each published statement with a number and a
criterion that can fail. The list shows what was found, when and at what cost; a study takes minutes to hours,
its quick form half a minute.
)",
           {{"peclet study --list", "all of them, with their verdicts"},
            {"peclet study zero-shear --folder /scratch/zero-shear", "hours, which may be interrupted"},
            {"peclet study --all --overnight", "every one, cheap ones first; the same command goes on"}},
           {0, 1, 2}));
  CLI::Option* const name =
      verb->add_option("study", options->name, "Which; the list unless given")->type_name("STUDY");
  verb->add_flag("--list", options->list, "List them with their verdicts, as without a name")->excludes(name);
  CLI::Option* const all =
      verb->add_flag("--all", options->all, "Every study in turn, with --overnight")->excludes(name);
  verb->add_flag("--overnight", options->overnight,
                 "All of them whole, with the points that take hours; goes on where an interruption was")
      ->needs(all);
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
  verb->add_flag("--json", options->json, "The list, for programs")->excludes(name)->excludes(all);
  verb->add_option(
          "--folder", options->folder,
          "Folder of the study's campaigns, with which a second call goes on; a temporary one unless "
          "given, with --all studies")
      ->type_name(value_name::folder);
  verb->add_option("--results", options->results,
                   "Folder of the studies; those that came with peclet unless given")
      ->type_name(value_name::folder);
  verbs.choose(verb, options, perform_study);
}

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

void add_other_verbs(VerbSet& verbs) {
  add_study(verbs);
  add_completion(verbs);
}

}  // namespace peclet::runner
