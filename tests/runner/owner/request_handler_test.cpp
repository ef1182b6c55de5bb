// Requests without processes: what each changes, what is refused, and that it happens once.
#include "runner/owner/request_handler.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <fstream>

#include "contract/durable_file.h"
#include "contract/sha256.h"
#include "runner/store/seed_store.h"
#include "tests/runner/owner/carrying_out.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

TEST_F(CarryingOut, ANewTargetReopensWhatItDoesNotSatisfy) {
  for (int seed = 0; seed < 8; ++seed) store(0, seed, seed % 2 == 0 ? 10 : 10.5);
  begin();
  ASSERT_TRUE(state_->scheduler().decided(0));
  document_["target"]["relative_tolerance"] = 0.001;
  document_["realisations"]["maximum"] = 90;
  write();
  EXPECT_EQ(ask(file_as_it_is()), "set: tolerance 5 % -> 0.1 %; maximum 40 -> 90");
  EXPECT_FALSE(state_->scheduler().decided(0));
  EXPECT_EQ(database_.campaign().target.target.tolerance, Tolerance(0.001));
  // All seeds of the stop test after the one of 8 seeds are queued.
  EXPECT_EQ(count("realisation WHERE state = 'queued' AND point_id = 1"), 2);
}

TEST_F(CarryingOut, PointsComeAndGoWithTheFile) {
  store(1, 0, 10);
  document_["sweep"][0]["values"] = {10, 100, 1000};
  write();
  EXPECT_EQ(ask(file_as_it_is()), "set: 2 points added; 1 point left out");
  ASSERT_EQ(state_->scheduler().points(), 3);
  EXPECT_EQ(state_->point(0).label, "peclet=10");
  EXPECT_EQ(state_->scheduler().begun(0), 1);  // begun at the point's earlier place
  EXPECT_EQ(ask(file_as_it_is()), "set: nothing differs");
}

TEST_F(CarryingOut, AFileThatWasChangedSinceItWasCheckedIsNotTakenOver) {
  const TakeOver checked = file_as_it_is();
  document_["realisations"]["maximum"] = 90;
  write();
  EXPECT_TRUE(ask(checked).starts_with("set: not taken over: " + file().string() + " changed after"));
  EXPECT_EQ(database_.campaign().target.maximum, 40);
}

TEST_F(CarryingOut, ASceneFileThatWasChangedSinceItWasCheckedIsNotTakenOver) {
  const fs::path scene = file().parent_path() / "scene.json";
  Json content = document_["scene"];
  write_durably(scene, content.dump());
  document_["scene"] = "scene.json";
  document_["realisations"]["maximum"] = 90;
  write();
  const TakeOver checked = file_as_it_is();
  content["volume_fraction"] = 0.31;
  write_durably(scene, content.dump());
  EXPECT_TRUE(ask(checked).starts_with("set: not taken over: "));
  EXPECT_EQ(database_.campaign().target.maximum, 40);
}

TEST_F(CarryingOut, OfTwoChangesOneAfterTheOtherTheSecondTakesBothOver) {
  document_["realisations"]["maximum"] = 90;
  write();
  const Request first = write_request(directory_, file_as_it_is());
  document_["target"]["relative_tolerance"] = 0.1;
  write();
  const Request second = write_request(directory_, file_as_it_is());
  requests_->carry_out();
  EXPECT_TRUE(answer(first).starts_with("set: not taken over: ")) << answer(first);
  EXPECT_EQ(answer(second), "set: tolerance 5 % -> 10 %; maximum 40 -> 90");
}

TEST_F(CarryingOut, AnObservableThatResultsLackIsRefusedAndNothingIsHalfDone) {
  store(0, 0, 10);
  begin();
  document_["target"]["observable"] = "colour";
  document_["sweep"][0]["values"] = {1};
  write();
  const std::string said = ask(file_as_it_is());
  EXPECT_NE(said.find("/target/observable: colour: must be a number that the results have: "
                      "control_variates/brownian_pairwise, pressure, "),
            std::string::npos)
      << said;
  EXPECT_EQ(database_.points().size(), 2U);
  EXPECT_EQ(database_.campaign().target.target.observable, "relative_viscosity");
  EXPECT_EQ(state_->campaign().target.observable, "relative_viscosity");
  EXPECT_EQ(state_->scheduler().points(), 2);
}

TEST_F(CarryingOut, TheEngineOfARunIsNotChangedUnderIt) {
  document_["engine"] = {"another-engine"};
  write();
  state_->admit_engine(plain_engine());
  EXPECT_NE(ask(file_as_it_is()).find("/engine: [\"another-engine\"]: cannot be changed while"),
            std::string::npos);
  begin();  // no engine runs it
  EXPECT_EQ(ask(file_as_it_is()), "set: parts of the file that affect no decision");
}

TEST_F(CarryingOut, ARunWithAnotherEngineDoesNotReopenWhatTheFirstOneDid) {
  for (int seed = 0; seed < 8; ++seed) store(0, seed, seed % 2 == 0 ? 10 : 10.5, "first");
  begin();
  state_->admit_engine(plain_engine("second"));  // the point is decided: nothing is mixed
  document_["target"]["relative_tolerance"] = 0.001;
  write();
  EXPECT_TRUE(
      ask(file_as_it_is()).starts_with("refused: peclet=1: has results of engine 1.0.0 (none) sha256"));
  EXPECT_TRUE(state_->scheduler().decided(0));
}

TEST_F(CarryingOut, APriorityDecidesWhoIsServedFirst) {
  EXPECT_EQ(state_->scheduler().next()->point, 0);
  EXPECT_EQ(ask(Prioritise{{"peclet=10"}, 5}), "set: priority 5: peclet=10");
  EXPECT_EQ(state_->scheduler().next()->point, 1);
  EXPECT_EQ(database_.points().at(1).priority, 5);
}

TEST_F(CarryingOut, ACancelledPointHoldsNothingUpUntilItIsTakenUpAgain) {
  EXPECT_EQ(ask(Cancel{{"peclet=1", hash(1).substr(0, 6)}, false}),
            "cancel: no more seeds: peclet=1, peclet=10");
  EXPECT_TRUE(state_->scheduler().finished());
  EXPECT_EQ(ask(Cancel{{"peclet=1"}, true}), "cancel: taken up again: peclet=1");
  EXPECT_FALSE(state_->scheduler().finished());
  EXPECT_EQ(state_->scheduler().next()->point, 0);
}

TEST_F(CarryingOut, APointThatNobodyKnowsIsRefusedWithTheNamesThatThereAre) {
  EXPECT_EQ(ask(Cancel{{"peclet=1", "peclet=7"}, false}),
            "refused: peclet=7: must be the label of one point, its values alone, or 4 or more digits of its "
            "hash; labels: peclet=1, "
            "peclet=10");
  EXPECT_FALSE(state_->scheduler().cancelled(0));
  EXPECT_EQ(listener_.notes.size(), 1U);
}

TEST_F(CarryingOut, ARetryQueuesWhatWasGivenUpWithACleanRecord) {
  crash_three_times(0, 2);
  crash_three_times(1, 0);
  blow_up(1, 4);
  begin();
  EXPECT_EQ(ask(Retry{{}, {}}),
            "retry: 2 seeds queued again, with a clean record: peclet=1 seed 2; peclet=10 seed 0; 1 seed "
            "ended with "
            "the engine's own verdict, and would end so again");
  EXPECT_EQ(count("realisation WHERE state = 'quarantined'"), 0);
  EXPECT_EQ(count("realisation WHERE state = 'failed'"), 1);
  EXPECT_EQ(count("attempt WHERE pardoned = 1"), 6);
  EXPECT_TRUE(SeedStore(database_).history(id(0), 2).empty());
  EXPECT_EQ(database_.attempts(id(0)).size(), 3U);  // all attempts are kept
  EXPECT_EQ(ask(Retry{{"peclet=1"}, {}}), "retry: no seed was given up: there is nothing to retry");
}

TEST_F(CarryingOut, ARetryMakesTheStopTestsAgainWithoutTheLoss) {
  for (int seed = 0; seed < 7; ++seed) store(0, seed, seed % 2 == 0 ? 10 : 10.5);
  crash_three_times(0, 7);
  begin();
  ASSERT_EQ(state_->scheduler().stop_tests(0).back().verdict, Verdict::converged_with_losses);
  ask(Retry{{"peclet=1"}, {7}});
  EXPECT_TRUE(state_->scheduler().stop_tests(0).empty());
  EXPECT_TRUE(database_.stop_tests(id(0)).empty());
  EXPECT_EQ(state_->scheduler().begun(0), 7);
  EXPECT_EQ(count("realisation WHERE point_id = 1 AND seed = 7 AND state = 'queued'"), 1);
}

TEST_F(CarryingOut, SeedsThatAreNamedMustHaveBeenGivenUp) {
  store(0, 0, 10);
  blow_up(0, 1);
  crash_three_times(0, 2);
  begin();
  const auto refusal = [&](int seed, const std::string& why) {
    const std::string said = ask(Retry{{"peclet=1"}, {2, seed}});
    EXPECT_EQ(said, "refused: --seed " + std::to_string(seed) + ": cannot be retried: at peclet=1 it " + why);
  };
  refusal(0, "has completed");
  refusal(1, "ended with the engine's own verdict, and would end so again (overlap)");
  refusal(3, "was not given up: it is queued");
  refusal(500, "has never been queued");
  EXPECT_NE(ask(Retry{{}, {2}}).find("--seed: needs the one point"), std::string::npos);
  EXPECT_EQ(count("realisation WHERE state = 'quarantined'"), 1);
}

TEST_F(CarryingOut, ARequestThatWasCarriedOutBeforeIsOnlyRemoved) {
  const Request request = write_request(directory_, Cancel{{"peclet=1"}, false});
  const std::string text = read_file(request_file(directory_, request.name));
  EXPECT_TRUE(requests_->carry_out());
  ask(Cancel{{"peclet=1"}, true});
  write_durably(request_file(directory_, request.name), text);  // its owner died before it could remove it
  EXPECT_FALSE(requests_->carry_out());
  EXPECT_FALSE(state_->scheduler().cancelled(0));
  EXPECT_TRUE(waiting_requests(directory_).empty());
}

TEST_F(CarryingOut, WhatIsNoRequestIsSetAside) {
  const char* const texts[] = {
      "",
      "{",
      "[]",
      R"({"version": 1, "verb": "sing"})",
      R"({"version": 2, "verb": "retry"})",
      "null",
      R"({"version": "1", "verb": "retry", "points": [], "seeds": []})",
      R"({"version": 1, "verb": 7})",
      R"({"version": 1, "verb": "cancel", "points": "peclet=1", "undo": false})",
      R"({"version": 1, "verb": "cancel", "points": [1], "undo": false})",
      R"({"version": 1, "verb": "cancel", "points": ["peclet=1"], "undo": 0})",
      R"({"version": 1, "verb": "cancel", "points": ["peclet=1"]})",
      R"({"version": 1, "verb": "retry", "points": [], "seeds": [-1]})",
      R"({"version": 1, "verb": "retry", "points": [], "seeds": [2147483648]})",
      R"({"version": 1, "verb": "retry", "points": [], "seeds": {"0": 1}})",
      R"({"version": 1, "verb": "take-over", "file": 7, "sha256": ""})",
      R"({"version": 1, "verb": "prioritise", "points": ["peclet=1"], "priority": 1e300})",
      R"({"version": 1, "verb": "prioritise", "points": ["peclet=1"], "priority": 1.5})",
      R"({"version": 1, "verb": "prioritise", "points": ["peclet=1"], "priority": 2147483648})",
      R"({"version": 1, "verb": "prioritise", "points": ["peclet=1"], "priority": -2147483649})",
      R"({"version": 1, "verb": "prioritise", "points": ["peclet=1"], "priority": 18446744073709551615})"};
  int number = 0;
  for (const char* const text : texts) {
    write_durably(directory_.requests() / (std::to_string(number++) + ".json"), text);
  }
  std::ofstream(directory_.requests() / "half.json.123.0.tmp") << "{";
  EXPECT_FALSE(requests_->carry_out());
  EXPECT_TRUE(waiting_requests(directory_).empty());
  EXPECT_EQ(listener_.warnings.size(), std::size(texts));
  for (const std::string& warning : listener_.warnings) EXPECT_LT(warning.size(), 500U) << warning;
  EXPECT_TRUE(fs::exists(directory_.requests() / "0.json.rejected"));
  EXPECT_EQ(count("point WHERE cancelled = 1 OR priority <> 0"), 0);
}

// Anything may have the name of a request: it is not followed or waited for, and the next request is heard.
TEST_F(CarryingOut, WhatIsNoFileIsSetAside) {
  const fs::path folder = directory_.requests();
  const fs::path outside = folder_.path() / "outside.json";
  write_durably(outside, R"({"version": 1, "verb": "cancel", "points": ["peclet=1"], "undo": false})");
  fs::create_symlink(outside, folder / "0.json");
  fs::create_symlink("1.json", folder / "1.json");
  ASSERT_EQ(mkfifo((folder / "2.json").c_str(), 0600), 0);
  fs::create_directories(folder / "3.json" / "full");
  write_durably(folder / "4.json", "");
  fs::resize_file(folder / "4.json", std::uintmax_t{1} << 40);
  fs::create_directories(folder / "5.json.rejected" / "full");  // where one would be moved to
  write_durably(folder / "5.json", "{");
  EXPECT_EQ(ask(Cancel{{"peclet=10"}, false}), "cancel: no more seeds: peclet=10");
  EXPECT_EQ(listener_.warnings.size(), 6U);
  EXPECT_TRUE(waiting_requests(directory_).empty());
  EXPECT_EQ(count("point WHERE cancelled = 1"), 1);
  EXPECT_TRUE(fs::exists(outside));
}

TEST_F(CarryingOut, ACampaignFileThatIsNoFileIsNotWaitedFor) {
  const fs::path pipe = folder_.path() / "pipe.json";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_NE(ask(TakeOver{pipe, std::string(64, '0')}).find("refused: "), std::string::npos);
}

TEST_F(CarryingOut, RequestsAreInOrderOfTime) {
  std::vector<std::string> names;
  names.reserve(50);
  for (int i = 0; i < 50; ++i)
    names.push_back(write_request(directory_, Cancel{{"peclet=1"}, i % 2 == 0}).name);
  std::vector<std::string> sorted = names;
  std::sort(sorted.begin(), sorted.end());
  EXPECT_EQ(names, sorted);
  EXPECT_EQ(waiting_requests(directory_).size(), 50U);
}

}  // namespace
}  // namespace peclet::runner
