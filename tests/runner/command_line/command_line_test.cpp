// Exit codes and messages of the program; verbs that only read write nothing.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <regex>

#include "contract/durable_file.h"
#include "contract/json.h"
#include "tests/runner/command_line/command_line_fixture.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

TEST_F(CommandLine, AFileMayFollowTheNameOfABundle) {
  write();
  const Answer answer = peclet("ingest --forget a --forget b small.json");
  EXPECT_EQ(answer.code, 2);
  EXPECT_NE(answer.text.find("--forget a: is not a bundle"), std::string::npos) << answer.text;
}

TEST_F(CommandLine, FaultsOfUsageAreExitCodeTwo) {
  write();
  for (const char* const arguments : {"",
                                      "stauts small.json",
                                      "status",
                                      "run small.json --workers 0",
                                      "validate",
                                      "export small.json --json --csv",
                                      "run small.json --time-limit -1",
                                      "run small.json --budget 0",
                                      "plan small.json --pilot x",
                                      "status absent.json",
                                      "explain small.json",
                                      "export .",
                                      "set absent.json",
                                      "set small.json --tolerance 5",
                                      "set small.json --priority 3",
                                      "set small.json --minimum ten",
                                      "cancel small.json",
                                      "cancel small.json peclet=1",
                                      "retry small.json",
                                      "retry small.json --seed -1"}) {
    const Answer answer = peclet(arguments);
    EXPECT_EQ(answer.code, 2) << arguments << ": " << answer.text;
    EXPECT_FALSE(answer.text.empty()) << arguments;
  }
  EXPECT_EQ(files(), 1);
}

TEST_F(CommandLine, HelpOfEveryVerbHasAnExample) {
  EXPECT_EQ(peclet("--version").code, 0);
  EXPECT_TRUE(peclet("--version").text.starts_with("peclet "));
  EXPECT_EQ(peclet("version").text, peclet("--version").text);
  for (const char* const verb :
       {"validate", "plan", "run", "status", "explain", "export", "report", "set", "cancel", "retry"}) {
    const Answer answer = peclet(std::string(verb) + " --help");
    EXPECT_EQ(answer.code, 0);
    EXPECT_TRUE(std::regex_search(answer.text, std::regex(std::string("\nExamples?:\n  peclet ") + verb)))
        << answer.text;
  }
}

TEST_F(CommandLine, ValidateAndPlanWriteNothing) {
  write();
  const Answer valid = peclet("validate small.json");
  EXPECT_EQ(valid.code, 0) << valid.text;
  EXPECT_TRUE(valid.text.starts_with("small: valid; 2 points, 8 to 40 seeds each")) << valid.text;
  EXPECT_EQ(peclet("plan small.json").code, 0);
  EXPECT_EQ(Json::parse(peclet("validate small.json --json").text)["points"].size(), 2U);
  EXPECT_EQ(Json::parse(peclet("plan small.json --json").text)["points"].size(), 2U);
  EXPECT_EQ(files(), 1);
}

TEST_F(CommandLine, AFaultyCampaignIsRefusedByEveryVerbThatReadsItAndNothingIsWritten) {
  campaign["target"]["relative_tolerance"] = 5;
  write();
  for (const char* const verb : {"validate", "plan", "run"}) {
    const Answer answer = peclet(std::string(verb) + " small.json");
    EXPECT_EQ(answer.code, 2);
    EXPECT_EQ(answer.text,
              "peclet: small.json: /target/relative_tolerance: 5: must be a number > 0 and < 1; 5 % is "
              "written 0.05\n");
  }
  EXPECT_EQ(files(), 1);
}

TEST_F(CommandLine, AnObservableThatTheEngineDoesNotMeasureIsRefusedBeforeAnythingRuns) {
  campaign["target"]["observable"] = "relative_vicosity";
  write();
  for (const char* const verb : {"validate", "plan", "run"}) {
    const Answer answer = peclet(std::string(verb) + " small.json");
    EXPECT_EQ(answer.code, 2);
    EXPECT_EQ(
        answer.text,
        "peclet: small.json: /target/observable: relative_vicosity: must be a number that the results of "
        "the point peclet=1 will have: relative_viscosity; did you mean relative_viscosity?\n");
  }
  EXPECT_EQ(files(), 1);
}

TEST_F(CommandLine, ASceneIsToldWhatACampaignIs) {
  campaign = {{"particles", {{"count", 10}}}, {"volume_fraction", 0.5}};
  write();
  for (const char* const verb : {"validate", "plan", "run", "status", "explain"}) {
    const Answer answer = peclet(std::string(verb) + " small.json");
    EXPECT_EQ(answer.code, 2) << verb;
    EXPECT_TRUE(answer.text.starts_with("peclet: small.json: is a scene, but must be a campaign: "))
        << answer.text;
    EXPECT_TRUE(says(answer.text, "`peclet init NEW.json`")) << answer.text;
  }
  EXPECT_EQ(files(), 1);
}

TEST_F(CommandLine, AShareMayBeGivenInPerCent) {
  write();
  EXPECT_EQ(peclet("set small.json --tolerance 8%").code, 0);
  const Json changed = Json::parse(read_file(file()));
  EXPECT_EQ(changed["target"]["relative_tolerance"], 0.08);
  EXPECT_TRUE(says(peclet("set small.json --tolerance 800%").text,
                   "--tolerance: 800%: must be a number > 0 and < 1"));
}

// Verbs that only read give the same advice as `run`.
TEST_F(CommandLine, ARenamedFileIsRecognisedByEveryVerb) {
  write();
  ASSERT_EQ(peclet("run small.json --quiet --workers 1").code, 0);
  std::filesystem::rename(file(), file().parent_path() / "new.json");
  const std::string advice = peclet("run new.json").text;
  EXPECT_TRUE(says(advice, "was it renamed?")) << advice;
  for (const char* const verb : {"status", "watch", "explain", "export"}) {
    EXPECT_EQ(peclet(std::string(verb) + " new.json").text, advice) << verb;
  }
}

TEST_F(CommandLine, ANumberThatIsNoneOrOutOfRangeIsNamedWithItsOptionAndWhatIsAllowed) {
  write();
  for (const auto& [option, allowed] :
       {std::pair{"run small.json --lease", "must be a number > 0 and <= 1000000000"},
        {"run small.json --backup", "must be a number > 0 and <= 1000000000"},
        {"run small.json --time-limit", "must be a number > 0 and <= 1000000000"},
        {"run small.json --budget", "must be a number > 0 and <= 1000000000"},
        {"run small.json --workers", "must be an integer >= 1 and <= 100000"},
        {"set small.json --tolerance", "must be a number > 0 and < 1"},
        {"set small.json --wait", "must be a number >= 0 and <= 1000000000"},
        {"retry small.json --seed", "must be an integer >= 0 and <= 2147483647"}}) {
    for (const char* const value : {"nan", "inf", "-1", "1e10", "1e999", "x", "1x", "0x1", "'1 2'"}) {
      const Answer answer = peclet(std::string(option) + "=" + value);
      EXPECT_EQ(answer.code, 2) << option << value;
      EXPECT_TRUE(answer.text.ends_with(std::string(": ") + allowed + "\n") ||
                  answer.text.find(std::string(": ") + allowed + "; ") != std::string::npos)
          << answer.text;
    }
  }
  EXPECT_EQ(peclet("run small.json --lease=nan").text,
            "peclet: run: --lease: nan: must be a number > 0 and <= 1000000000\n");
  EXPECT_EQ(files(), 1);
}

TEST_F(CommandLine, WholeNumbersMayBeSpeltInAnyWayThatIsWhole) {
  write();
  // A number that is read as octal, or not at all, would be refused or run with another count.
  EXPECT_EQ(peclet("set small.json --maximum 05e1").code, 0);
  EXPECT_EQ(Json::parse(read_file(file()))["realisations"]["maximum"], 50);
  EXPECT_EQ(peclet("set small.json --maximum 060").code, 0);
  EXPECT_EQ(Json::parse(read_file(file()))["realisations"]["maximum"], 60);
}

TEST_F(CommandLine, FaultsOfUsageAreOneLineThatNamesTheVerb) {
  write();
  const std::pair<const char*, const char*> faults[] = {
      {"", "peclet: a verb is missing; `peclet --help` lists them\n"},
      {"stauts small.json",
       "peclet: stauts: there is no such verb; `peclet --help` lists them; did you mean status?\n"},
      {"cancel small.json",
       "peclet: cancel: point: is missing: Labels of points, their values alone, or 4 or more digits of "
       "their hashes; `peclet cancel --help` says more\n"},
      {"run small.json --wrokers 2",
       "peclet: run: --wrokers: there is no such option; `peclet run --help` lists them; did you mean "
       "--workers?\n"},
      {"run small.json -j 2",
       "peclet: run: -j: there is no such option; `peclet run --help` lists them; did you mean --workers?\n"},
      {"small.json run", "peclet: small.json: the verb goes first: peclet run small.json\n"},
      {"run small.json --lease",
       "peclet: run: --lease: must have one value; `peclet run --help` says more\n"},
      {"export small.json --csv --json",
       "peclet: export: --json: cannot stand beside --csv; `peclet export --help` says more\n"},
      {"validate small.json more.json",
       "peclet: validate: more.json: is one word too many; `peclet validate --help` says more\n"},
      {"help nonsense", "peclet: nonsense: there is no such verb; `peclet --help` lists them\n"}};
  for (const auto& [arguments, message] : faults) {
    const Answer answer = peclet(arguments);
    EXPECT_EQ(answer.code, 2) << arguments;
    EXPECT_EQ(answer.text, message) << arguments;
  }
}

TEST_F(CommandLine, HelpMayBeAskedForInFrontOfTheVerb) {
  EXPECT_EQ(peclet("help").text, peclet("--help").text);
  EXPECT_EQ(peclet("help explain").text, peclet("explain --help").text);
  EXPECT_EQ(peclet("help explain").code, 0);
}

TEST_F(CommandLine, ACampaignMayComeThroughAPipeButIsNotRunFromOne) {
  write();
  ASSERT_EQ(mkfifo((file().parent_path() / "pipe").c_str(), 0600), 0);
  const std::string fed = "pipe 2>&1 & timeout 60 cat small.json > pipe; wait $!";
  const Answer valid = peclet("validate " + fed);
  EXPECT_EQ(valid.code, 0) << valid.text;
  EXPECT_EQ(valid.text, peclet("validate small.json").text);
  const Answer run = peclet("run " + fed);
  EXPECT_EQ(run.code, 2);
  EXPECT_NE(run.text.find("name its folder with --directory"), std::string::npos) << run.text;
  EXPECT_EQ(files(), 2);
}

TEST_F(CommandLine, ANameThatNoFileCanHaveIsAFaultOfUsage) {
  fs::create_symlink("loop.json", file().parent_path() / "loop.json");
  for (const char* const verb : {"validate", "run", "status", "export", "set", "doctor"}) {
    const Answer loop = peclet(std::string(verb) + " loop.json");
    EXPECT_EQ(loop.code, 2) << verb;
    EXPECT_NE(loop.text.find("loop.json"), std::string::npos) << loop.text;
    const Answer name = peclet(std::string(verb) + ' ' + std::string(5000, 'n'));
    EXPECT_EQ(name.code, 2) << verb;
    EXPECT_LT(name.text.size(), 500U);
  }
}

TEST_F(CommandLine, AnEngineThatIsAcceptedByAWrongNameIsRefusedBeforeAnythingIsWritten) {
  write();
  for (const char* const verb : {"run small.json", "hand-over slurm small.json --shared ."}) {
    const Answer answer = peclet(std::string(verb) + " --accept-engine no-such-engine");
    EXPECT_EQ(answer.code, 2);
    EXPECT_TRUE(
        answer.text.starts_with("peclet: --accept-engine: no-such-engine: must be the version, or 6 or more"))
        << answer.text;
    EXPECT_EQ(files(), 1) << verb;
  }
}

TEST_F(CommandLine, TheNextStepNamesTheFolderThatWasChosenAndIsQuotedForTheShell) {
  write();
  EXPECT_EQ(peclet("set small.json --directory 'my runs' --maximum 50").text,
            "small.json is changed; it has not been run yet: peclet run small.json --directory 'my runs'\n");
  EXPECT_NE(peclet("status small.json --directory elsewhere")
                .text.find("`peclet run small.json --directory elsewhere`"),
            std::string::npos);
  ASSERT_EQ(peclet("run small.json --directory 'my runs' --quiet --workers 1").code, 0);
  campaign["target"]["relative_tolerance"] = 0.1;
  write();
  EXPECT_NE(peclet("status small.json --directory 'my runs'")
                .text.find(
                    "`peclet set small.json --directory 'my runs'` or `peclet run small.json --directory 'my "
                    "runs'` takes it over"),
            std::string::npos);
  const Answer cancelled = peclet("cancel small.json 1 --directory 'my runs'");
  EXPECT_EQ(cancelled.code, 0) << cancelled.text;
}

TEST_F(CommandLine, ARunCanBeLookedAtByFileAndByFolder) {
  write();
  ASSERT_EQ(peclet("run small.json --workers 2 --quiet").code, 0);
  for (const char* const given : {"small.json", "small.peclet"}) {
    const std::string place = given;
    EXPECT_EQ(peclet("status " + place + " --check").code, 0);
    EXPECT_EQ(Json::parse(peclet("status " + place + " --json").text)["exit_code"], 0);
    EXPECT_EQ(peclet("explain " + place + " peclet=10").code, 0);
    EXPECT_EQ(Json::parse(peclet("explain " + place + " --json").text)["points"].size(), 2U);
    EXPECT_EQ(Json::parse(peclet("export " + place).text)["points"].size(), 2U);
  }
  EXPECT_EQ(peclet("export small.json --csv --output small.csv").code, 0);
  EXPECT_EQ(peclet("export small.json --csv").text, peclet("export small.peclet --csv | cat").text);
  EXPECT_EQ(peclet("export small.json --csv > /dev/full").code, 1);
}

TEST_F(CommandLine, LabelsOfUsersAreTextInAReport) {
  campaign["sweep"][0]["values"] = {"<script>&", 1};
  write();
  ASSERT_EQ(peclet("run small.json --workers 2 --quiet").code, 0);
  ASSERT_EQ(peclet("report small.json --output small.html").code, 0);
  const std::string page = peclet("report small.peclet").text;
  EXPECT_EQ(page, read_file(file().parent_path() / "small.html"));
  EXPECT_NE(page.find("\\u003cscript\\u003e\\u0026"), std::string::npos);
  EXPECT_EQ(page.find("<script>&"), std::string::npos);
}

TEST_F(CommandLine, AChangedCampaignFileIsSaid) {
  write();
  ASSERT_EQ(peclet("run small.json --workers 2 --quiet").code, 0);
  EXPECT_EQ(peclet("status small.json").text.find("note:"), std::string::npos);
  campaign["realisations"]["maximum"] = 50;
  write();
  const Answer answer = peclet("status small.json");
  EXPECT_EQ(answer.code, 0);
  EXPECT_NE(answer.text.find("note: small.json has changed since it was last run"), std::string::npos);
  std::ofstream(file()) << "{";
  EXPECT_NE(peclet("status small.json").text.find("has a fault"), std::string::npos);
}

TEST_F(CommandLine, ADatabaseThatIsNoneIsExitCodeSix) {
  write();
  fs::create_directory(file().parent_path() / "small.peclet");
  std::ofstream(file().parent_path() / "small.peclet/campaign.db") << std::string(5000, 'x');
  for (const char* const verb : {"status", "explain", "export", "plan"}) {
    EXPECT_EQ(peclet(std::string(verb) + " small.json").code, 6) << verb;
  }
}

}  // namespace
}  // namespace peclet::runner
