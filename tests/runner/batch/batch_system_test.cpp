#include "runner/batch/batch_system.h"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <fstream>

#include "contract/input_error.h"
#include "runner/engines/command.h"
#include "tests/runner/runner_fixture.h"

namespace peclet::runner {
namespace {

TEST(Command, SaysWhatItPrintedAndHowItLeft) {
  const CommandAnswer good = run_command({"sh", "-c", "echo yes; echo but >&2"}, std::chrono::seconds(10));
  EXPECT_TRUE(good.succeeded());
  EXPECT_EQ(good.output, "yes\n");
  EXPECT_EQ(good.errors, "but\n");
  const CommandAnswer bad = run_command({"sh", "-c", "echo why >&2; exit 3"}, std::chrono::seconds(10));
  EXPECT_FALSE(bad.succeeded());
  EXPECT_EQ(bad.complaint(), "exit status 3: why");
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

}  // namespace
}  // namespace peclet::runner
