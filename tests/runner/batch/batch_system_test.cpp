#include "runner/batch/batch_system.h"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "contract/errors.h"
#include "runner/engines/engine_process.h"
#include "tests/runner/runner_fixture.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

TEST(Command, SaysWhatItPrintedAndHowItLeft) {
  const CommandAnswer good = run_command({"sh", "-c", "echo yes; echo but >&2"}, std::chrono::seconds(10));
  EXPECT_TRUE(good.succeeded());
  EXPECT_EQ(good.output, "yes\n");
  EXPECT_EQ(good.errors, "but\n");
  const CommandAnswer bad = run_command({"sh", "-c", "echo why >&2; exit 3"}, std::chrono::seconds(10));
  EXPECT_FALSE(bad.succeeded());
  EXPECT_EQ(bad.complaint(), "exit status 3: why");
}

// The input is longer than the 64 KiB that a pipe holds.
TEST(Command, ReadsItsInputToTheEnd) {
  const std::string input(100000, 'x');
  EXPECT_EQ(run_command({"cat"}, std::chrono::seconds(10), input).output, input);
  EXPECT_EQ(run_command({"cat"}, std::chrono::seconds(10)).output, "");
}

TEST(Command, ThatDoesNotEndIsKilledWithItsChildren) {
  const auto start = std::chrono::steady_clock::now();
  const CommandAnswer answer = run_command({"sh", "-c", "sleep 100 & sleep 100"}, std::chrono::seconds(1));
  EXPECT_TRUE(answer.timed_out);
  EXPECT_EQ(answer.ending.signal, SIGKILL);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(50));
}

TEST(Command, ThatIsNotThereThrows) {
  EXPECT_THROW(run_command({"/no/such/program"}, std::chrono::seconds(1)), std::system_error);
}

TEST(BatchTemplate, PlaceholdersAreReplacedAndOtherSignsStay) {
  const std::map<std::string, std::string> values{{"NAME", "flow"}, {"LAST", "7"}};
  EXPECT_EQ(fill_in("--job-name=@NAME@ --array=0-@LAST@", values, "job.sh"), "--job-name=flow --array=0-7");
  EXPECT_EQ(fill_in("--signal=B:USR1@120 me@HOST x@", values, "job.sh"), "--signal=B:USR1@120 me@HOST x@");
  EXPECT_THROW(fill_in("@NOMEN@", values, "job.sh"), InputError);
}

TEST(BatchTemplate, IsBuiltInForSomeSystems) {
  const std::map<std::string, std::string> query_commands{
      {"slurm", "squeue"}, {"pbs", "qselect"}, {"lsf", "bjobs"}};
  for (const auto& [system, command] : query_commands) {
    const BatchTemplate scripts = batch_template(system, "");
    EXPECT_EQ(scripts.size(), 5) << system;
    EXPECT_TRUE(says(scripts.at("query.sh"), command)) << system;
  }
  EXPECT_THROW(batch_template("condor", ""), InputError);
}

TEST(BatchTemplate, TakesFilesOfAFolderBeforeThoseThatAreBuiltIn) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "job.sh") << "mine";
  const BatchTemplate scripts = batch_template("slurm", folder.path());
  EXPECT_EQ(scripts.at("job.sh"), "mine");
  EXPECT_EQ(scripts.at("query.sh"), read_file(fs::path(PECLET_SOURCE_DIR) / "templates/slurm/query.sh"));
  EXPECT_THROW(batch_template("condor", folder.path()), InputError);  // four files are missing
}

TEST(BatchTemplate, IsPrintedByName) {
  const fs::path templates = fs::path(PECLET_SOURCE_DIR) / "templates";
  EXPECT_EQ(template_text("slurm-nodes"), read_file(templates / "slurm" / "nodes.sh"));
  EXPECT_TRUE(says(template_text(""), "slurm-job\nslurm-largest\nslurm-nodes\n"));
  EXPECT_THROW(template_text("slurm"), InputError);
}

class Query : public testing::Test {
 protected:
  std::optional<QueryAnswer> answer(const std::string& script) {
    std::ofstream(folder_.path() / "query.sh") << script;
    return query_job(folder_.path(), "name", why);
  }
  std::string why;

 private:
  TemporaryFolder folder_;
};

TEST_F(Query, SaysOfEachTaskWhetherItIsStillThere) {
  const std::optional<QueryAnswer> known = answer("printf '7 0 running\\n7 1 waiting\\n7 2 ended\\n'");
  ASSERT_TRUE(known) << why;
  EXPECT_EQ(known->jobs, std::vector<std::string>{"7"});
  EXPECT_TRUE(known->alive(0));
  EXPECT_TRUE(known->alive(1));
  EXPECT_FALSE(known->alive(2));
  EXPECT_FALSE(known->alive(3));
}

TEST_F(Query, OfAJobThatWasSubmittedTwiceCountsTheOneThatLives) {
  const std::optional<QueryAnswer> known =
      answer("printf '7 0 ended\\n9 0 running\\n7 1 running\\n9 1 ended\\n'");
  ASSERT_TRUE(known) << why;
  EXPECT_EQ(known->jobs, (std::vector<std::string>{"7", "9"}));
  EXPECT_TRUE(known->alive(0));
  EXPECT_TRUE(known->alive(1));
}

TEST_F(Query, WithoutAWholeAnswerNobodyKnows) {
  EXPECT_FALSE(answer("echo 7 0 running; exit 1"));
  EXPECT_EQ(why, "exit status 1: 7 0 running");
  EXPECT_FALSE(answer("echo 7 0 sleeping"));
  EXPECT_FALSE(answer("echo 7 N/A running"));
  EXPECT_FALSE(answer("echo slurm_load_jobs error: Unable to contact slurm controller"));
  EXPECT_TRUE(answer(":"));
}

// The built-in scripts, with sbatch, squeue and scancel that know a second cluster.
class SlurmScripts : public testing::Test {
 protected:
  SlurmScripts() {
    for (const auto& [name, text] : batch_template("slurm", "")) std::ofstream(folder_.path() / name) << text;
    fs::create_directory(folder_.path() / "bin");
    program("sbatch", "echo \"$*\" >submitted; echo '7;nautilus'");
    program("squeue",
            "case $* in *--clusters=nautilus*) echo CLUSTER: nautilus; echo; echo 7 0 RUNNING; echo 7 1 "
            "COMPLETED ;; "
            "esac");
    program("scancel", "case $* in *--clusters=nautilus*) : >cancelled ;; esac");
    setenv("PATH", ((folder_.path() / "bin").string() + ":" + path_).c_str(), 1);
  }
  ~SlurmScripts() override {
    setenv("PATH", path_.c_str(), 1);
    for (const char* const name : {"SBATCH_CLUSTERS", "SLURM_CLUSTERS", "SQUEUE_PARTITION", "SCANCEL_STATE"})
      unsetenv(name);
  }
  void program(const std::string& name, const std::string& script) {
    const fs::path file = folder_.path() / "bin" / name;
    std::ofstream(file) << "#!/bin/sh\ncd '" << folder_.path().string() << "'\n" << script << '\n';
    fs::permissions(file, fs::perms(0755));
  }
  Submission submit(const std::vector<std::string>& options) {
    fs::remove(folder_.path() / "clusters");
    return submit_job(folder_.path(), "name", options);
  }
  void expect_found(const std::string& how) {
    std::string why;
    const std::optional<QueryAnswer> answer = query_job(folder_.path(), "name", why);
    ASSERT_TRUE(answer) << how << ": " << why;
    EXPECT_TRUE(answer->alive(0)) << how;
    EXPECT_FALSE(answer->alive(1)) << how;
    EXPECT_TRUE(cancel_job(folder_.path(), "name", why));
    EXPECT_TRUE(fs::remove(folder_.path() / "cancelled")) << how;
  }

  TemporaryFolder folder_;
  std::string path_ = std::getenv("PATH");
};

TEST_F(SlurmScripts, AskTheClusterToWhichTheJobWent) {
  const std::vector<std::vector<std::string>> ways{
      {"--clusters=nautilus"}, {"-Mnautilus"}, {"-M", "nautilus"}, {"--partition=x", "--clus=nautilus"}};
  for (const auto& options : ways) {
    EXPECT_TRUE(std::holds_alternative<JobTaken>(submit(options))) << options.front();
    expect_found(options.front());
  }
  for (const char* const name : {"SBATCH_CLUSTERS", "SLURM_CLUSTERS"}) {
    setenv(name, "nautilus", 1);
    submit({});
    setenv("SLURM_CLUSTERS", "atlantis", 1);  // of a later shell
    expect_found(name);
    unsetenv("SBATCH_CLUSTERS");
    unsetenv("SLURM_CLUSTERS");
  }
  std::ofstream(folder_.path() / "job.sh") << "#!/bin/sh\n#SBATCH --time=1\n#SBATCH --clusters=nautilus\n";
  submit({});
  expect_found("the script");
}

TEST_F(SlurmScripts, AreNotLedAstrayByVariablesOfTheUser) {
  program("squeue", "[ -n \"$SQUEUE_PARTITION\" ] || echo 7 0 RUNNING");
  program("scancel", "[ -n \"$SCANCEL_STATE\" ] || : >cancelled");
  submit({});
  setenv("SQUEUE_PARTITION", "urgent", 1);
  setenv("SCANCEL_STATE", "PENDING", 1);
  expect_found("SQUEUE_PARTITION and SCANCEL_STATE");
}

TEST_F(SlurmScripts, RefuseOptionsWithWhichTheJobIsNotFoundOrNotSubmitted) {
  for (const char* const option : {"-Jmine", "--job-name=mine", "-a0-3", "--array=0-3", "-W", "--wait", "-Q",
                                   "--quiet", "--test-only", "--wrap=true"}) {
    const Submission answer = submit({option});
    ASSERT_TRUE(std::holds_alternative<JobRefused>(answer)) << option;
    EXPECT_TRUE(says(std::get<JobRefused>(answer).complaint, option));
    EXPECT_FALSE(fs::exists(folder_.path() / "submitted")) << option;
  }
}

TEST_F(SlurmScripts, SayHowToStayWithinALimitOnTasks) {
  program("sbatch", "echo 'sbatch: error: QOSMaxSubmitJobPerUserLimit' >&2; exit 1");
  const Submission answer = submit({});
  ASSERT_TRUE(std::holds_alternative<JobRefused>(answer));
  EXPECT_TRUE(says(std::get<JobRefused>(answer).complaint, "--largest-array N"));
}

}  // namespace
}  // namespace peclet::runner
