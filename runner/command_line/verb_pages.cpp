#include "runner/command_line/verb_pages.h"

#include <sstream>
#include <utility>

#include "contract/exit_codes.h"

namespace peclet::runner {
namespace {

constexpr std::size_t help_width = 100;

// Lines of no more than `help_width` characters.
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

// Paragraphs of `prose` are separated by empty lines; where its lines end means nothing.
VerbPage page(const std::string& prose, std::vector<VerbExample> examples, std::vector<int> exit_codes) {
  VerbPage made{{}, std::move(examples), std::move(exit_codes)};
  std::istringstream lines(prose);
  std::string paragraph;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() && !paragraph.empty()) made.paragraphs.push_back(std::exchange(paragraph, ""));
    if (!line.empty()) paragraph += (paragraph.empty() ? "" : " ") + line;
  }
  if (!paragraph.empty()) made.paragraphs.push_back(paragraph);
  return made;
}

std::map<std::string, VerbPage> pages() {
  return {
      {"init", page(R"(
The file is a whole campaign that runs in minutes: 100 spheres with friction at three Péclet numbers.
Change it to what you want to know; `peclet validate` says what is wrong with it.
)",
                    {}, {0, 1, 2})},
      {"validate",
       page(R"(
Reads the campaign and asks its engine about the scene of every point: the groups that follow from it,
the time step, and warnings. The first fault is named with its place in the file, its value and what is
allowed, a target that no result would have included. The file may be a pipe.
)",
            {{"peclet validate <(my-generator)", "what a program writes"},
             {"peclet validate flow-curve.json --json | jq '.points[].timestep'", "the time steps alone"}},
            {0, 1, 2})},
      {"plan", page(R"(
The work is counted in particle-steps, and in processor time where realisations have been run before:
from the fewest seeds that a point may take to the most. Where none has, one of the point in the middle is
tried for two seconds, in a temporary folder, and the table says that its times are a guess.
)",
                    {}, {0, 1, 2, 5, 6, 75})},
      {"run",
       page(R"(
Runs seeds of every point until the interval of its mean is within the tolerance, or all seeds that are
allowed have ended. The same command goes on with a campaign that was stopped or killed, and takes up
changes of its file; nothing that has finished is run again.

Ctrl-C (or SIGTERM) lets the workers write checkpoints and stop, a second one stops at once; either way
the exit code is 75 and the campaign can be resumed. Progress goes to standard error, the table at the
end to standard output; with --jsonl events take its place, which schema/README.md describes.
)",
            {{"peclet run flow-curve.json --time-limit 28800", "eight hours of it; the same again tomorrow"},
             {"peclet run flow-curve.json --jsonl | jq -r 'select(.event == \"decided\") | .point.label'",
              "follow it with a program"}},
            {0, 1, 2, 3, 5, 6, 75})},
      {"status",
       page(R"(
Shows the seeds that have ended, the mean and its standard error so far, the interval at the last look
and the verdict of every point. It only reads, and may be used at any time.
)",
            {{"peclet status flow-curve.json --json", "for programs; schema/README.md describes it"}},
            {0, 1, 2, 3, 4, 6})},
      {"watch", page(R"(
Ends when every point is decided, with the exit code that `status --check` would have, or at Ctrl-C,
which does nothing to the campaign. A campaign that has not been run yet is waited for. Off a terminal it
prints the table whenever it changes.
)",
                     {}, {0, 1, 2, 3, 4, 6})},
      {"explain", page(R"(
A point is named by its label (peclet=10 volume_fraction=0.5), by its values alone as in a row of the
tables ("10 0.5"), or by the beginning of its hash.

Lists the looks at a point, a bootstrap interval beside Student's, lost seeds with what their engines
said last, whether the window is long enough, and what would bring the point further.
)",
                       {{"peclet explain flow-curve.peclet", "all points"}}, {0, 1, 2, 6})},
      {"export",
       page(R"(
The canonical form holds what depends on campaign, seeds and engine alone, so that two runs of one
campaign can be compared byte by byte, however many workers they had and whatever killed them.
--output replaces a file whole, follows a link, writes to a device, a FIFO or /dev/stdout, and says on
standard error where it wrote, unless --quiet.

Estimates are of the seeds of each point's last look. --csv has a column for every scalar that was
measured, --long a row for every number, with names, units and axes as the engine gives them.
)",
            {{"peclet export flow-curve.json --canonical | sha256sum", "one number for all results"},
             {"peclet export flow-curve.json --long --output all.csv", "profiles and distributions, too"}},
            {0, 1, 2, 6})},
      {"results",
       page(R"(
The database holds results deflated; this prints them as their engines wrote them, with blocks, costs and where
they come from, and with the point and whether its last look counts the seed ("deciding"). One that is surplus
must not enter a mean: which seeds end first depends on the machine. Also while the campaign runs.
)",
            {{"peclet results flow-curve.json | jq -c 'select(.deciding) | .result.mean.relative_viscosity'",
              "the values of all points, for R, Julia and others: schema/README.md"},
             {"peclet results flow-curve.json peclet=10 --seed 3 | jq .result", "one realisation"}},
            {0, 1, 2, 6})},
      {"report", page(R"(
The page holds what was asked, the table of estimates with their intervals, a chart over the swept
variable, lost seeds by cause, what every mark means, where the numbers come from and the commands that
make them again. It needs no other file and no network, reads well on paper, and depends on the database
alone: the same one gives the same bytes.
)",
                      {}, {0, 1, 2, 6})},
      {"hand-over", page(R"(
Turns the seeds that the next looks need into job arrays. The database stays on this machine; nodes see
the folder --shared and the two programs. Without --follow it hands over once, and `peclet ingest` takes
in what has been done. The answer is the same, byte for byte, as that of `peclet run`.

When the batch system refuses a job, its seeds stay here and the exit code is 1. When it is not known whether it has
taken one, the seeds are out until a job of that name has been looked for.
)",
                         {}, {0, 1, 2, 3, 5, 6, 75})},
      {"ingest",
       page(R"(
Takes results, failures and preempted tasks in from the folder that is shared with the nodes, and hands
nothing over.

Seeds of which nobody knows anything (their folder is gone, the batch system does not answer) stay out, because
they may be running. --forget gives a bundle of them up by the name that `peclet ingest` prints. The exit code is 1
while the folder of seeds that are out is not there.
)",
            {{"peclet ingest flow-curve.json --cancel", "end the jobs; `peclet run` can have their seeds"},
             {"peclet ingest flow-curve.json --forget flow-curve-1a2b3c-0001",
              "its folder is gone, and so are its jobs"}},
            {0, 1, 2, 5, 6})},
      {"task", page(R"(
Runs the seeds of the task one after another, those apart that have ended already. SIGTERM, SIGINT and
SIGUSR1 make the engine save a checkpoint and leave.
)",
                    {}, {0, 1, 2, 6, 75})},
      {"set", page(R"(
Changes target, numbers of seeds or priorities. The values are changed in the campaign's file, of which every
other byte stays, and the campaign takes the file over as it is; without options it does only that, with
points that you have added to the sweep, for instance. A running campaign does so within seconds, and this
verb waits for it; points of a finished one that are no longer decided go on with `peclet run`.
)",
                   {{"peclet set flow-curve.json", "take over a file that was edited"},
                    {"peclet set flow-curve.json --point peclet=10 --priority 1", "this point first"}},
                   {0, 1, 2, 4, 6})},
      {"cancel",
       page(R"(
The points get no more seeds and hold nothing up; seeds that run are saved and put back. What has been done
is kept and shown.
)",
            {{"peclet cancel flow-curve.json peclet=10 --undo", "take it up again"}}, {0, 1, 2, 4, 6})},
      {"retry", page(R"(
Seeds are given up after three failures that were their own: crashes, or no progress. What the engine itself
called failed (an overlap, a step too large) would fail again, and is not retried.
)",
                     {}, {0, 1, 2, 4, 6})},
      {"study",
       page(R"(
A study remakes published figures with error bars and answers each published statement with a number and a
criterion that can fail. The list shows what was found, when and at what cost; a study takes minutes to hours,
its quick form half a minute.
)",
            {{"peclet study --list", "all of them, with their verdicts"},
             {"peclet study zero-shear --folder /scratch/zero-shear", "hours, which may be interrupted"}},
            {0, 1, 2})},
      {"backup", page(R"(
`peclet run` makes such backups by itself; this makes one now, or elsewhere. The copy is checked before
it takes the place of the one before. Of the folder's path only the last part is made: where a disk is
not mounted, there is an error and no copy on another disk. A copy that turns out to be on the campaign's
own file system is said to be.
)",
                      {}, {0, 1, 2, 6})},
      {"restore", page(R"(
What was there is kept aside. The campaign then goes on with `peclet run` to the same results.
)",
                       {}, {0, 1, 2, 5, 6})},
      {"doctor", page(R"(
Says what is wrong, how bad it is and what cures it. Without --repair nothing is changed. With it, among
other things, checkpoints of seeds that no point needs any more are removed: they cost their time again
should the tolerance be tightened.
)",
                      {}, {0, 1, 2, 5, 6})},
      {"completion",
       page(R"(
For bash and zsh, put the line of the example (with the name of the shell) into ~/.bashrc or ~/.zshrc;
for fish, write the script to ~/.config/fish/completions/peclet.fish. `cmake --install` puts all three
where the shells find them by themselves.
)",
            {{"peclet completion fish --output ~/.config/fish/completions/peclet.fish", ""}}, {0, 1, 2})},
      {"manual",
       page(R"(
The pages are made of the same verbs and options as --help. `cmake --install` puts them where man(1)
finds them.
)",
            {{"peclet manual --folder ~/.local/share/man/man1", "then `man peclet-run`"}}, {0, 1, 2})}};
}

}  // namespace

const VerbPage& verb_page(const std::string& verb) {
  static const std::map<std::string, VerbPage> all = pages();
  static const VerbPage none;
  const auto page = all.find(verb);
  return page == all.end() ? none : page->second;
}

const std::map<int, std::string>& exit_codes() {
  static const std::map<int, std::string> codes{
      {ExitCode::done, "done; of a run: every point converged"},
      {ExitCode::error, "error"},
      {ExitCode::usage, "usage, or faulty input; nothing has been written"},
      {ExitCode::unconverged,
       "finished, but some points are capped or near the maximum, failed, cancelled or lost seeds"},
      {ExitCode::unfinished,
       "not finished yet; of set, cancel and retry: asked for, and not carried out yet"},
      {ExitCode::owned, "another process owns the campaign"},
      {ExitCode::integrity, "integrity: the database is damaged, or a seed gave two different results"},
      {ExitCode::stopped,
       "stopped by a signal or a time limit, or at the end of its budget; the same command goes on"}};
  return codes;
}

std::string help_footer(const std::string& verb, const std::string& example) {
  const VerbPage& page = verb_page(verb);
  std::string text;
  for (const std::string& paragraph : page.paragraphs) text += wrapped(paragraph) + '\n';
  text += page.examples.empty() ? "Example:\n" : "Examples:\n";
  text += "  " + example + '\n';
  for (const VerbExample& more : page.examples) {
    text += (more.purpose.empty() ? "" : "  # " + more.purpose + '\n') + "  " + more.command + '\n';
  }
  text.pop_back();
  return text;
}

}  // namespace peclet::runner
