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

TEST(BatchTemplate, OfSlurmIsBuiltIn) {
  const BatchTemplate slurm = batch_template("slurm", "");
  EXPECT_NE(slurm.at("job.sh").find("#SBATCH --job-name=@NAME@"), std::string::npos);
  EXPECT_NE(slurm.at("query.sh").find("squeue"), std::string::npos);
  EXPECT_THROW(batch_template("pbs", ""), InputError);
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
    unsetenv("SBATCH_CLUSTERS");
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
  setenv("SBATCH_CLUSTERS", "nautilus", 1);
  submit({});
  expect_found("SBATCH_CLUSTERS");
  unsetenv("SBATCH_CLUSTERS");
  std::ofstream(folder_.path() / "job.sh") << "#!/bin/sh\n#SBATCH --time=1\n#SBATCH --clusters=nautilus\n";
  submit({});
  expect_found("the script");
}

TEST_F(SlurmScripts, RefuseAnotherName) {
  for (const char* const option : {"-Jmine", "--job-name=mine", "-a0-3", "--array=0-3"}) {
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
