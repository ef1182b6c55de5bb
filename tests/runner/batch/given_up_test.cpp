// Seeds whose state the batch system does not tell: none stays out for good, and none counts twice.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "contract/errors.h"
#include "runner/command_line/ask_owner.h"
#include "runner/maintenance/doctor.h"
#include "tests/runner/batch/batch_fixture.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

constexpr int tasks = 5;  // two seeds each
constexpr const char* all_waiting = "0 waiting\n1 waiting\n2 waiting\n3 waiting\n4 waiting\n";

class GivenUp : public BatchFixture {
 protected:
  void take_away() const { fs::rename(shared(), folder() / "elsewhere"); }
  void put_back() const { fs::rename(folder() / "elsewhere", shared()); }
  std::string diagnosis() const {
    DoctorOptions doctor;
    doctor.campaign = options.campaign;
    return examine_campaign(doctor).text;
  }
  std::string refusal() const {
    try {
      hand_over();
    } catch (const SubmissionRefused& refused) {
      return refused.what();
    }
    return "";
  }
  // Returns the number of results that were not taken in yet.
  std::ptrdiff_t spooled() const {
    return std::count_if(fs::directory_iterator(shared() / "spool"), fs::directory_iterator(),
                         [](const fs::directory_entry& entry) { return entry.is_regular_file(); });
  }
};

TEST_F(GivenUp, ARefusedSubmissionTakesNothingOut) {
  submissions("refused");
  const std::string said = refusal();
  EXPECT_NE(said.find("exit status 1: no such partition"), std::string::npos) << said;
  EXPECT_EQ(seeds_out(), 0);
  EXPECT_TRUE(fs::is_empty(shared() / "bundles"));
  EXPECT_EQ(run_locally(), 0);
  EXPECT_EQ(answer(), local_answer());
}

TEST_F(GivenUp, ASubmitCommandThatCannotBeFoundIsARefusal) {
  std::ofstream(options.template_folder / "submit.sh") << "/no/such/sbatch\n";
  EXPECT_NE(refusal().find("/no/such/sbatch"), std::string::npos);
  EXPECT_EQ(seeds_out(), 0);
}

TEST_F(GivenUp, ACommandThatFailsAfterItsJobWasTakenIsNoRefusal) {
  submissions("late");
  states(all_waiting);
  EXPECT_EQ(refusal(), "");
  EXPECT_EQ(seeds_out(), 10);
  EXPECT_EQ(text("SELECT job FROM bundle"), "1");
}

TEST_F(GivenUp, WhatWasTakenBeforeARefusalStaysOutAndTheRestIsOpen) {
  submissions("one");
  options.largest_array = 2;
  states("0 waiting\n1 waiting\n");
  EXPECT_NE(refusal(), "");
  EXPECT_EQ(seeds_out(), 4);
  EXPECT_EQ(submitted(), 1);
  submissions("ok");
  EXPECT_EQ(refusal(), "");
  EXPECT_EQ(seeds_out(), 10);
}

TEST_F(GivenUp, WhoFollowsStopsAtARefusalWhenNothingIsOut) {
  submissions("refused");
  options.follow = true;
  EXPECT_NE(refusal(), "");
  EXPECT_EQ(seeds_out(), 0);
}

TEST_F(GivenUp, AMissingFolderIsAnAnswerAndNotAWait) {
  ASSERT_EQ(hand_over(), 0);
  states(all_waiting);
  take_away();
  EXPECT_EQ(ingest(), 1);
  EXPECT_EQ(cancel(), 1);
  EXPECT_EQ(run_locally(), 75);
  cancel_points({options.campaign, {}, {"peclet=2"}});
  EXPECT_THROW(hand_over(), InputError);
  EXPECT_FALSE(fs::exists(shared())) << "what is not mounted is not made anew";
  EXPECT_EQ(seeds_out(), 10) << "they may be running";
  EXPECT_NE(diagnosis().find("`peclet ingest --forget " + name(1) + "`"), std::string::npos) << diagnosis();
}

TEST_F(GivenUp, ADoctorNamesABundleOfWhichNobodyHasHeard) {
  submissions("unheard");
  ASSERT_EQ(hand_over(), 0);
  EXPECT_NE(diagnosis().find("10 seeds are out in the bundle " + name(1)), std::string::npos) << diagnosis();
  EXPECT_EQ(forget(1), 0);
  EXPECT_NE(diagnosis().find("sound"), std::string::npos) << diagnosis();
}

TEST_F(GivenUp, ForgottenSeedsRunAgainAndGiveTheSameAnswer) {
  ASSERT_EQ(hand_over(), 0);
  states(all_waiting);
  take_away();
  EXPECT_EQ(forget(1), 0);
  EXPECT_EQ(seeds_out(), 0);
  EXPECT_EQ(run_locally(), 0);
  EXPECT_EQ(answer(), local_answer());
}

TEST_F(GivenUp, LateResultsOfAForgottenBundleCountOnceAndAreNotComputedAgain) {
  ASSERT_EQ(hand_over(), 0);
  states(all_waiting);
  take_away();
  ASSERT_EQ(forget(1), 0);
  put_back();
  for (const int index : {0, 1}) ASSERT_EQ(run_task(1, index), 0);
  EXPECT_EQ(run_locally(), 0);
  EXPECT_EQ(count("SELECT count(*) FROM attempt"), 6) << "four of ten came from the tasks";
  EXPECT_EQ(answer(), local_answer());
  for (const int index : {2, 3}) ASSERT_EQ(run_task(1, index), 0);
  EXPECT_EQ(spooled(), 4);
  EXPECT_EQ(ingest(), 0);
  EXPECT_EQ(spooled(), 0);
  EXPECT_EQ(count("SELECT count(*) FROM result"), 10);
  EXPECT_EQ(count("SELECT total(suspect) FROM point"), 0);
  EXPECT_EQ(answer(), local_answer());
}

TEST_F(GivenUp, TasksThatFindThemselvesForgottenRunNothing) {
  ASSERT_EQ(hand_over(), 0);
  states(all_waiting);
  take_away();
  ASSERT_EQ(forget(1), 0);
  put_back();
  ASSERT_EQ(ingest(), 0);
  for (int index = 0; index < tasks; ++index) EXPECT_EQ(run_task(1, index), 0);
  EXPECT_EQ(spooled(), 0);
}

TEST_F(GivenUp, ANameThatIsNoBundleIsRefused) {
  ASSERT_EQ(hand_over(), 0);
  states(all_waiting);
  try {
    ingest_campaign({options.campaign, {}, false, true, false, {"batch-0001"}});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(error.allowed().find(name(1)), std::string::npos) << error.what();
  }
  EXPECT_EQ(seeds_out(), 10);
}

TEST_F(GivenUp, WhatCannotBePutIntoTheJobScriptIsRefusedBeforeAnythingIsWritten) {
  options.shared = folder() / "a\nb";
  EXPECT_THROW(hand_over(), InputError);
  EXPECT_FALSE(fs::exists(options.shared));
  EXPECT_FALSE(fs::exists(folder() / "batch.peclet"));
}

}  // namespace
}  // namespace peclet::runner
