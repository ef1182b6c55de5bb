// Manual pages and completions say what --help says, and are what man, groff and shells take.
#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "contract/durable_file.h"
#include "runner/text/roff.h"
#include "tests/runner/command_line/shell.h"
#include "tests/runner/runner_fixture.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

const std::string program = PECLET_PROGRAM;

std::set<std::string> matches(const std::string& text, const std::string& pattern) {
  const std::regex expression(pattern, std::regex::multiline);
  std::set<std::string> found;
  for (std::sregex_iterator match(text.begin(), text.end(), expression), end; match != end; ++match) {
    found.insert((*match)[1]);
  }
  return found;
}

// Names at the beginning of lines of the list of verbs, and of the options of one.
std::set<std::string> verbs_of_help() {
  const std::string help = shell(program + " --help").text;
  const std::size_t begin = help.find("Subcommands:"), end = help.find("Exit codes");
  return matches(help.substr(begin, end - begin), "^  ([a-z-]+) ");
}
std::set<std::string> options_of_help(const std::string& verb) {
  return matches(shell(program + " " + verb + " --help").text, "^  (?:-h,)?(--[a-z-]+)");
}

// Words that bash offers for the last of `words`, in `folder`.
std::set<std::string> offered(const std::string& words, const fs::path& folder) {
  const std::string script = "cd '" + folder.string() + "'; eval \"$('" + program +
                             "' completion bash)\"; COMP_WORDS=(peclet " + words +
                             "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _peclet; printf '%s\\n' "
                             "\"${COMPREPLY[@]}\"";
  std::ofstream(folder.parent_path() / "complete.sh") << script;
  std::istringstream lines(shell("bash -u '" + (folder.parent_path() / "complete.sh").string() + "'").text);
  std::set<std::string> found;
  for (std::string line; std::getline(lines, line);) found.insert(line);
  return found;
}

class Completion : public testing::Test {
 protected:
  Completion() : folder(root_.path() / "work") {
    fs::create_directories(folder / "flow curve.peclet");
    fs::create_directories(folder / "studies");
    for (const char* const name : {"flow curve.json", "scene.json", "notes.txt"})
      std::ofstream(folder / name);
  }

 private:
  TemporaryFolder root_;

 protected:
  fs::path folder;
};

using Words = std::set<std::string>;

TEST_F(Completion, OffersAllVerbsFirstAndThenTheOptionsOfTheVerb) {
  const Words verbs = verbs_of_help();
  EXPECT_GE(verbs.size(), 17U);
  EXPECT_EQ(offered("''", folder), verbs);
  EXPECT_EQ(offered("sta", folder), Words{"status"});
  EXPECT_EQ(offered("--", folder), (Words{"--help", "--version"}));
  for (const std::string& verb : verbs)
    EXPECT_EQ(offered(verb + " --", folder), options_of_help(verb)) << verb;
}

TEST_F(Completion, OffersCampaignFilesWhereOneIsExpectedAndFoldersOnTheWay) {
  EXPECT_EQ(offered("run ''", folder), (Words{"flow curve.json", "scene.json", "studies"}));
  EXPECT_EQ(offered("run --workers 4 s", folder), (Words{"scene.json", "studies"}));
  EXPECT_EQ(offered("status f", folder), (Words{"flow curve.json", "flow curve.peclet"}));
  EXPECT_EQ(offered("hand-over slurm ''", folder), (Words{"flow curve.json", "scene.json", "studies"}));
}

TEST_F(Completion, OffersWhatAnOptionTakes) {
  EXPECT_EQ(offered("run scene.json --directory ''", folder), (Words{"flow curve.peclet", "studies"}));
  EXPECT_EQ(offered("run scene.json --directory = s", folder),
            Words{"studies"});  // as bash splits --directory=s
  EXPECT_EQ(offered("hand-over slurm --option = --partition = short s", folder),
            (Words{"scene.json", "studies"}));
  EXPECT_EQ(offered("export scene.json --output n", folder), Words{"notes.txt"});
  EXPECT_EQ(offered("completion ''", folder), (Words{"bash", "zsh", "fish"}));
  EXPECT_EQ(offered("run scene.json --workers ''", folder), Words{""});  // a number: nothing to offer
}

TEST(Completions, OfZshAndFishHaveEveryVerbAndOption) {
  const std::string zsh = shell(program + " completion zsh").text,
                    fish = shell(program + " completion fish").text;
  for (const std::string& verb : verbs_of_help()) {
    EXPECT_TRUE(says(zsh, "'" + verb + ":")) << verb;
    EXPECT_TRUE(says(fish, "-n __fish_use_subcommand -a " + verb + " ")) << verb;
    const std::size_t begin = zsh.find("        " + verb + ") _arguments");
    ASSERT_NE(begin, std::string::npos) << verb;
    const std::string arguments = zsh.substr(begin, zsh.find(";;", begin) - begin);
    for (const std::string& option : options_of_help(verb)) {
      EXPECT_TRUE(says(arguments, option + "[")) << verb << ' ' << option;
      EXPECT_TRUE(says(fish, "'__fish_seen_subcommand_from " + verb + "' -l " + option.substr(2) + " "))
          << verb << ' ' << option;
    }
  }
}

TEST(Completions, OfAnUnknownShellIsAFaultOfUsage) {
  EXPECT_EQ(shell(program + " completion tcsh").code, 2);
  EXPECT_EQ(shell(program + " manual stauts").code, 2);
}

TEST(Manual, HasAPageForEveryVerbWithItsOptionsAndSections) {
  const TemporaryFolder folder;
  ASSERT_EQ(shell(program + " manual --folder '" + folder.path().string() + "'").code, 0);
  const std::string index = read_file(folder.path() / "peclet.1");
  for (const std::string& verb : verbs_of_help()) {
    const std::string page = read_file(folder.path() / ("peclet-" + verb + ".1"));
    EXPECT_EQ(page, shell(program + " manual " + verb).text);
    std::string name = roff_code(verb);
    EXPECT_TRUE(says(index, ".BR peclet\\-" + name + " (1)\n")) << verb;
    for (const char* const section :
         {"NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "EXIT STATUS", "FILES", "EXAMPLES", "SEE ALSO"}) {
      EXPECT_TRUE(says(page, std::string("\n.SH ") + section + '\n')) << verb << ' ' << section;
    }
    for (const std::string& option : options_of_help(verb)) {
      EXPECT_TRUE(says(page, "\\fB" + roff_code(option) + "\\fR")) << verb << ' ' << option;
    }
  }
}

// groff knows when a page is not what its macros expect; it then says so.
TEST(Manual, GroffHasNothingToSayAgainstItsPages) {
  const TemporaryFolder folder;
  ASSERT_EQ(shell(program + " manual --folder '" + folder.path().string() + "'").code, 0);
  for (const fs::directory_entry& page : fs::directory_iterator(folder.path())) {
    const Answer complaints = shell("groff -man -Tutf8 -ww -z '" + page.path().string() + "'");
    EXPECT_EQ(complaints.text, "") << page.path();
    EXPECT_EQ(complaints.code, 0);
  }
  const std::string text =
      shell("groff -man -Tascii -P-cbou '" + (folder.path() / "peclet-run.1").string() + "'").text;
  EXPECT_TRUE(says(text, "75     stopped ")) << text;
}

// `verify` names unknown keys and values that it does not understand.
TEST(SystemdUnit, SystemdHasNothingToSayAgainstIt) {
  const TemporaryFolder runtime;
  const Answer verdict = shell("XDG_RUNTIME_DIR='" + runtime.path().string() +
                               "' systemd-analyze --user verify --man=no '" PECLET_SOURCE_DIR
                               "/templates/systemd/peclet@.service'");
  EXPECT_EQ(verdict.text, "");
  EXPECT_EQ(verdict.code, 0);
}

TEST(Roff, NothingOfATextIsTakenForARequestOrAnEscape) {
  EXPECT_EQ(roff_text(".hidden"), "\\&.hidden");
  EXPECT_EQ(roff_code("'a' \\ b-c"), "\\(aqa\\(aq \\e b\\-c");
  EXPECT_EQ(roff_text("see `peclet run` and --json, half-way"),
            "see \\fBpeclet run\\fR and \\-\\-json, half-way");
  EXPECT_EQ(roff_text("Péclet"), "P\\[u00E9]clet");
}

}  // namespace
}  // namespace peclet::runner
