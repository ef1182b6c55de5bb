// Seeds that are handed over to an unreliable batch system: a few scripts, and tasks that the test runs.
#include "runner/command_line/hand_over.h"

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <fstream>
#include <future>
#include <thread>

#include "contract/errors.h"
#include "runner/batch/bundle_files.h"
#include "runner/command_line/ask_owner.h"
#include "runner/engines/engine_process.h"
#include "runner/store/locks.h"
#include "tests/runner/batch/batch_fixture.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

constexpr const char* all_waiting = "0 waiting\n1 waiting\n2 waiting\n3 waiting\n4 waiting\n";

using HandOver = BatchFixture;

TEST_F(HandOver, GivesTheSameAnswerAsALocalRun) {
  ASSERT_EQ(hand_over(), 0);
  for (int index = 0; index < tasks; ++index) EXPECT_EQ(run_task(1, index), 0);
  EXPECT_EQ(ingest(), 0);
  EXPECT_EQ(count("SELECT count(*) FROM attempt WHERE outcome = 'result'"), 10);
  EXPECT_EQ(answer(), local_answer());
  EXPECT_FALSE(fs::exists(bundle(1))) << "nothing went wrong, so nothing is kept";
  EXPECT_TRUE(fs::is_empty(shared() / "checkpoints"));
}

TEST_F(HandOver, ASeedIsInOneBundleAndNobodyElseRunsIt) {
  ASSERT_EQ(hand_over(), 0);
  states(all_waiting);
  EXPECT_EQ(hand_over(), 0);
  EXPECT_EQ(submitted(), 1);
  EXPECT_EQ(run_locally(), 75);
  EXPECT_EQ(count("SELECT count(*) FROM attempt JOIN bundle_seed USING (point_id, seed)"), 0);
  EXPECT_EQ(seeds_out(), 10);
}

TEST_F(HandOver, ADryRunSubmitsNothing) {
  options.dry_run = true;
  EXPECT_EQ(hand_over(), 0);
  EXPECT_EQ(submitted(), 0);
  EXPECT_EQ(seeds_out(), 0);
}

TEST_F(HandOver, ACancelledPointIsNotHandedOver) {
  options.dry_run = true;
  ASSERT_EQ(hand_over(), 0);
  options.dry_run = false;
  cancel_points({options.campaign, {}, {"peclet=2"}});
  ASSERT_EQ(hand_over(), 0);
  EXPECT_EQ(seeds_out(), 5);
}

TEST_F(HandOver, WhoFollowsCarriesOutWhatIsAskedForWithoutWaitingForTheNextTurn) {
  ASSERT_EQ(hand_over(), 0);
  states(all_waiting);
  options.follow = true;
  options.interval = 1e6;
  std::atomic<int> code = -1;
  auto owner = std::async(std::launch::async, [&] { code = hand_over(); });
  ASSERT_TRUE(
      comes_true([&] { return current_owner(campaign_directory(options.campaign, {})).has_value(); }));
  cancel_points({options.campaign, {}, {"peclet=1", "peclet=2"}});
  states("");                                                            // the cancelled jobs leave
  if (!comes_true([&] { return code != -1; })) kill(getpid(), SIGTERM);  // its next turn is days away
  owner.get();
  EXPECT_EQ(code, 3);
  EXPECT_EQ(seeds_out(), 0);
  EXPECT_EQ(count("SELECT total(blamed) FROM attempt"), 0);
}

TEST_F(HandOver, WhoFollowsWaitsForALockOfAnotherProgram) {
  ASSERT_EQ(hand_over(), 0);
  states(all_waiting);
  options.follow = true;
  options.interval = 0.05;
  std::atomic<int> code = -1;
  auto owner = std::async(std::launch::async, [&] { code = hand_over(); });
  const CampaignDirectory directory = campaign_directory(options.campaign, {});
  ASSERT_TRUE(comes_true([&] { return current_owner(directory).has_value(); }));
  {
    Connection other(directory.database().string(), Connection::Access::read_write, 20'000);
    const Transaction lock(other);
    std::this_thread::sleep_for(std::chrono::seconds(3));  // every turn wants to write
    EXPECT_EQ(code, -1);
  }
  cancel_points({options.campaign, {}, {"peclet=1", "peclet=2"}});
  states("");
  if (!comes_true([&] { return code != -1; })) kill(getpid(), SIGTERM);
  owner.get();
  EXPECT_EQ(code, 3);
  EXPECT_EQ(seeds_out(), 0);
}

TEST_F(HandOver, WhoFollowsMakesBackups) {
  ASSERT_EQ(hand_over(), 0);
  for (int index = 0; index < tasks; ++index) ASSERT_EQ(run_task(1, index), 0);
  options.follow = true;
  options.interval = 0.01;
  ASSERT_EQ(hand_over(), 0);
  const fs::path backup = campaign_directory(options.campaign, {}).backup() / "backup.db";
  ASSERT_TRUE(fs::exists(backup));
  EXPECT_EQ(Database::open_reader(backup).connection().integer(
                "SELECT count(*) FROM realisation WHERE state = 'done'"),
            10);
}

TEST_F(HandOver, AnArrayIsNotLargerThanAsked) {
  options.largest_array = 2;
  ASSERT_EQ(hand_over(), 0);
  EXPECT_EQ(submitted(), 3);
  EXPECT_EQ(count("SELECT max(tasks) FROM bundle"), 2);
  EXPECT_EQ(count("SELECT count(DISTINCT point_id || ' ' || seed) FROM bundle_seed"), 10);
}

TEST_F(HandOver, AJobWhoseAnswerWasLostIsFoundByItsName) {
  submissions("lost");
  ASSERT_EQ(hand_over(), 0);
  EXPECT_EQ(count("SELECT count(*) FROM bundle WHERE job IS NULL"), 1);
  submissions("ok");
  states(all_waiting);
  ASSERT_EQ(hand_over(), 0);
  EXPECT_EQ(submitted(), 1);
  EXPECT_EQ(text("SELECT job FROM bundle"), "1");
}

TEST_F(HandOver, AJobWhoseAnswerWasLostAndThatHasEndedIsFoundByWhatItLeft) {
  submissions("lost");
  ASSERT_EQ(hand_over(), 0);
  for (int index = 0; index < tasks; ++index) ASSERT_EQ(run_task(1, index), 0);
  std::ofstream(folder() / "jobs") << "";  // the batch system has forgotten it
  ASSERT_EQ(hand_over(), 0);
  EXPECT_EQ(submitted(), 0);
  EXPECT_EQ(answer(), local_answer());
}

TEST_F(HandOver, ASubmissionThatNobodyHeardOfIsMadeAgain) {
  submissions("unheard");
  ASSERT_EQ(hand_over(), 0);
  EXPECT_EQ(submitted(), 0);
  EXPECT_EQ(seeds_out(), 10);
  submissions("ok");
  states(all_waiting);
  ASSERT_EQ(hand_over(), 0);
  EXPECT_EQ(submitted(), 1);
  EXPECT_EQ(count("SELECT count(*) FROM bundle"), 1);
}

TEST_F(HandOver, NothingIsSubmittedAgainWhileNobodyAnswers) {
  submissions("lost");
  ASSERT_EQ(hand_over(), 0);
  queries(false);
  ASSERT_EQ(hand_over(), 0);
  EXPECT_EQ(submitted(), 1);
}

TEST_F(HandOver, AFailedQueryIsNoNewsOfAnyTask) {
  ASSERT_EQ(hand_over(), 0);
  ASSERT_EQ(run_task(1, 0), 0);
  queries(false);
  ASSERT_EQ(ingest(), 0);
  EXPECT_EQ(seeds_out(), 8) << "what has ended is taken in all the same";
  EXPECT_EQ(count("SELECT count(*) FROM bundle_seed WHERE outcome IS NOT NULL AND outcome != 'result'"), 0);
  queries(true);
  states("1 waiting\n2 nonsense\n");  // an invalid answer
  ASSERT_EQ(ingest(), 0);
  EXPECT_EQ(seeds_out(), 8);
}

TEST_F(HandOver, TasksThatHaveGoneGiveTheirSeedsBackWithoutBlame) {
  ASSERT_EQ(hand_over(), 0);
  states("0 running\n1 ended\n2 waiting\n");  // 3 and 4 are not listed
  ASSERT_EQ(ingest(), 0);
  EXPECT_EQ(seeds_out(), 4);
  EXPECT_EQ(count("SELECT count(*) FROM bundle_seed WHERE outcome = 'returned'"), 6);
  EXPECT_EQ(count("SELECT total(blamed) FROM attempt"), 0);
  ASSERT_EQ(hand_over(), 0);
  EXPECT_EQ(submitted(), 2);
  EXPECT_EQ(seeds_out(), 10);
}

TEST_F(HandOver, AResultThatItsTaskHadNoTimeToPublishIsTakenInWhenTheTaskHasGone) {
  ASSERT_EQ(hand_over(), 0);
  for (int index = 0; index < tasks; ++index) ASSERT_EQ(run_task(1, index), 0);
  fs::path moved;
  for (const fs::directory_entry& entry : fs::directory_iterator(shared() / "spool")) {
    if (!entry.is_regular_file()) continue;
    const Json result = read_json(entry.path());
    const Manifest manifest = read_manifest(bundle(1) / "manifest.json");
    if (result["point"] != manifest.seeds[0].point || result["seed"] != manifest.seeds[0].seed) continue;
    moved = bundle(1) / "tasks" / "0" / (entry.path().stem().string() + ".result");
    fs::rename(entry.path(), moved);
    break;
  }
  ASSERT_FALSE(moved.empty());
  fs::remove(bundle(1) / "ended" / "0.json");
  states("0 running\n");
  ASSERT_EQ(ingest(), 0);
  EXPECT_EQ(seeds_out(), 1);
  states("");
  ASSERT_EQ(ingest(), 0);
  EXPECT_EQ(seeds_out(), 0);
  EXPECT_EQ(count("SELECT count(*) FROM bundle_seed WHERE outcome = 'result'"), 10);
  EXPECT_EQ(answer(), local_answer());
}

TEST_F(HandOver, ALateResultOfATaskThatSeemedGoneCountsOnce) {
  ASSERT_EQ(hand_over(), 0);
  ASSERT_EQ(ingest(), 0);  // nothing is listed: all have gone
  ASSERT_EQ(hand_over(), 0);
  for (const int number : {1, 2}) {
    for (int index = 0; index < tasks; ++index) ASSERT_EQ(run_task(number, index), 0);
  }
  ASSERT_EQ(ingest(), 0);
  EXPECT_EQ(count("SELECT count(*) FROM result"), 10);
  EXPECT_EQ(count("SELECT total(suspect) FROM point"), 0);
  EXPECT_EQ(answer(), local_answer());
}

TEST_F(HandOver, TheEnginesOwnFailuresAreBlamedAndKillsAreNot) {
  set("PECLET_FAKE_FAULTS", "crash:0 kill:1x2 overlap:2");
  for (int round = 1; round <= 3; ++round) {
    ASSERT_EQ(hand_over(), 0);
    const auto last = static_cast<int>(count("SELECT tasks FROM bundle ORDER BY bundle_id DESC LIMIT 1"));
    for (int index = 0; index < last; ++index) ASSERT_EQ(run_task(round, index), 0);
    ASSERT_EQ(ingest(), 0);
  }
  EXPECT_EQ(count("SELECT count(*) FROM attempt WHERE outcome = 'crashed' AND blamed AND signal = 6"), 6);
  EXPECT_EQ(count("SELECT count(*) FROM attempt WHERE outcome = 'killed' AND NOT blamed AND signal = 9"), 4);
  EXPECT_EQ(count("SELECT count(*) FROM realisation WHERE state = 'quarantined' AND cause = 'crashed'"), 2);
  EXPECT_EQ(count("SELECT count(*) FROM realisation WHERE state = 'failed' AND cause = 'overlap'"), 2);
  EXPECT_EQ(count("SELECT count(*) FROM realisation WHERE state = 'done'"), 6);
  EXPECT_EQ(answer(), local_answer());
}

TEST_F(HandOver, CancelledJobsGiveTheirSeedsBack) {
  ASSERT_EQ(hand_over(), 0);
  states(all_waiting);
  EXPECT_EQ(cancel(), 0);
  EXPECT_EQ(seeds_out(), 0);
  EXPECT_EQ(run_locally(), 0);
  EXPECT_EQ(answer(), local_answer());
}

TEST_F(HandOver, CancellingTakesBackWhatWasNeverSubmitted) {
  submissions("unheard");
  ASSERT_EQ(hand_over(), 0);
  ASSERT_EQ(seeds_out(), 10);
  EXPECT_EQ(cancel(), 0);
  EXPECT_EQ(seeds_out(), 0);
}

TEST_F(HandOver, FollowingStopsWhenTasksGoAgainAndAgainWithoutHavingBegun) {
  options.follow = true;
  options.interval = 0.01;
  EXPECT_THROW(hand_over(), EngineError);  // no task is ever listed, and none leaves a trace
  EXPECT_EQ(submitted(), 3);
}

TEST_F(HandOver, WhatIsMissingIsSaid) {
  options.shared.clear();
  EXPECT_THROW(hand_over(), InputError);
  fs::remove(options.template_folder / "query.sh");
  EXPECT_THROW(hand_over(), InputError);
  options.template_folder.clear();
  EXPECT_THROW(hand_over(), InputError) << "there is no batch system called test";
}

}  // namespace
}  // namespace peclet::runner
