// Manual pages and completion agree with --help, and groff and bash accept them.
#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <set>
#include <sstream>

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

// Return the names of the verbs in --help, and those of the options of a verb.
std::set<std::string> verbs_of_help() {
  const std::string help = shell(program + " --help").text;
  const std::size_t begin = help.find("Subcommands:"), end = help.find("Exit codes");
  return matches(help.substr(begin, end - begin), "^  ([a-z-]+) ");
}
std::set<std::string> options_of_help(const std::string& verb) {
  return matches(shell(program + " " + verb + " --help").text, "^  (?:-h,)?(--[a-z-]+)");
}

// Returns the words that bash offers for the last of `words`, in `folder`.
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
  EXPECT_EQ(offered("completion ''", folder), Words{"bash"});
  EXPECT_EQ(offered("run scene.json --workers ''", folder), Words{""});  // a number: nothing to offer
}

TEST(Completions, OfAnUnknownShellIsAFaultOfUsage) { EXPECT_EQ(shell(program + " completion tcsh").code, 2); }

#ifdef HELP2MAN
TEST(Manual, HasAPageForEveryVerbThatGroffTakes) {
  const TemporaryFolder folder;
  const std::string pages = "sh '" PECLET_SOURCE_DIR "/cmake/manual/pages.sh' '" + program + "' '";
  ASSERT_EQ(shell(pages + folder.path().string() + "'").text, "");
  std::set<std::string> verbs = verbs_of_help();
  verbs.insert("");
  for (const std::string& verb : verbs) {
    const std::string name = verb.empty() ? "peclet" : "peclet-" + verb;
    const std::string page = (folder.path() / (name + ".1")).string();
    // -ww prints every warning about the macros of man.
    EXPECT_EQ(shell("groff -K utf8 -man -Tutf8 -ww -z '" + page + "'").text, "") << name;
    const std::string text = shell("groff -K utf8 -man -Tascii -rLL=200n -P-cbou '" + page + "'").text;
    EXPECT_TRUE(says(text, "\n       " + name + " - ")) << text;
    for (const char* const section : {"SYNOPSIS", "DESCRIPTION", "OPTIONS", "EXIT STATUS", "FILES"})
      EXPECT_TRUE(says(text, std::string("\n") + section + '\n')) << name << ' ' << section;
    for (const std::string& option : options_of_help(verb)) {
      EXPECT_TRUE(std::regex_search(text, std::regex("\n       (-h,)?" + option + "[ \n]")))
          << name << option;
    }
    EXPECT_TRUE(says(text, "\n       2      usage, or faulty input")) << name;
  }
}
#endif

// `verify` names unknown keys and values that it does not understand.
TEST(SystemdUnit, SystemdHasNothingToSayAgainstIt) {
  const TemporaryFolder runtime;
  const Answer verdict = shell("XDG_RUNTIME_DIR='" + runtime.path().string() +
                               "' systemd-analyze --user verify --man=no '" PECLET_SOURCE_DIR
                               "/templates/systemd/peclet@.service'");
  EXPECT_EQ(verdict.text, "");
  EXPECT_EQ(verdict.code, 0);
}

}  // namespace
}  // namespace peclet::runner
