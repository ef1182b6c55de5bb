// Requests and the ledger without processes: what each changes, what is refused, and that it happens once.
#include "runner/requests/request_handler.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <fstream>

#include "contract/durable_file.h"
#include "contract/input_error.h"
#include "contract/sha256.h"
#include "runner/reports/explain.h"
#include "runner/reports/export.h"
#include "runner/reports/status.h"
#include "runner/stores/engine_row.h"
#include "runner/stores/point_store.h"
#include "runner/stores/result_store.h"
#include "runner/stores/seed_store.h"
#include "tests/runner/runner_fixture.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

class CarryingOut : public testing::Test {
 protected:
  CarryingOut() {
    create_folders(directory_);
    document_ = {{"name", "small"},
                 {"scene", {{"fluid", {{"viscosity", 1}}}}},
                 {"sweep", {{{"set", "/peclet"}, {"values", {1, 10}}}}},
                 {"target", {{"relative_tolerance", 0.05}}},
                 {"realisations", {{"minimum", 8}, {"maximum", 40}}}};
    write();
    PointStore(database_).adopt(read_campaign(file()));
    begin();
  }

  fs::path file() const { return folder_.path() / "small.json"; }
  void write() const { write_durably(file(), document_.dump(2)); }
  // An owner starts.
  void begin() {
    ledger_.emplace(database_, read_campaign(file()), directory_, listener_, 2);
    requests_.emplace(database_, *ledger_, directory_, listener_);
  }
  TakeOver file_as_it_is() const { return {file(), sha256(read_file(file()))}; }

  // "cancel: no more seeds: peclet=1"
  std::string ask(const Wish& wish) {
    const Request request = write_request(directory_, wish);
    requests_->carry_out();
    EXPECT_FALSE(fs::exists(request_file(directory_, request.name)));
    return answer(request);
  }
  std::string answer(const Request& request) {
    const std::optional<EventRecord> event = database_.event_of(request.name);
    return event ? event->kind + ": " + event->message : "";
  }
  std::int64_t count(const std::string& what) {
    return database_.connection().integer("SELECT count(*) FROM " + what);
  }
  std::int64_t id(int place) { return database_.points().at(static_cast<std::size_t>(place)).id; }
  std::string hash(int place) { return database_.points().at(static_cast<std::size_t>(place)).hash; }

  void store(int place, int seed, double viscosity, const std::string& engine = "engine") {
    ResultStore(database_).store(parse_result(plain_result(hash(place), seed, viscosity, engine).dump()),
                                 database_.campaign().target.target);
  }
  void crash_three_times(int place, int seed) {
    for (int i = 0; i < 3; ++i) {
      const std::int64_t attempt =
          SeedStore(database_).begin_attempt(id(place), seed, 0, 4711, engine_row(database_, plain_engine()));
      SeedStore(database_).end_attempt(attempt, {AttemptOutcome::crashed, 5});
    }
    SeedStore(database_).quarantine(id(place), seed, "crashed");
  }
  void blow_up(int place, int seed) {
    Json result = plain_result(hash(place), seed, 0);
    result["ending"]["cause"] = "overlap";
    result["mean"] = result["blocks"] = nullptr;
    ResultStore(database_).store(parse_result(result.dump()), database_.campaign().target.target);
  }

  TemporaryFolder folder_;
  CampaignDirectory directory_{folder_.path() / "small.peclet"};
  Json document_;
  Database database_ = [this] {
    create_folders(directory_);
    return Database::open_owner(directory_.database());
  }();
  SilentListener listener_;
  std::optional<Ledger> ledger_;
  std::optional<RequestHandler> requests_;
};

TEST_F(CarryingOut, ANewTargetReopensWhatItDoesNotSatisfy) {
  for (int seed = 0; seed < 8; ++seed) store(0, seed, seed % 2 == 0 ? 10 : 10.5);
  begin();
  ASSERT_TRUE(ledger_->scheduler().decided(0));
  document_["target"]["relative_tolerance"] = 0.001;
  document_["realisations"]["maximum"] = 90;
  write();
  EXPECT_EQ(ask(file_as_it_is()), "set: tolerance 5 % -> 0.1 %; maximum 40 -> 90");
  EXPECT_FALSE(ledger_->scheduler().decided(0));
  EXPECT_EQ(database_.campaign().target.target.tolerance, Tolerance(0.001));
  // The look after that of 8 seeds: all of its seeds are in the queue.
  EXPECT_EQ(count("realisation WHERE state = 'queued' AND point_id = 1"), 2);
}

TEST_F(CarryingOut, PointsComeAndGoWithTheFile) {
  store(1, 0, 10);
  document_["sweep"][0]["values"] = {10, 100, 1000};
  write();
  EXPECT_EQ(ask(file_as_it_is()), "set: 2 points added; 1 point left out");
  ASSERT_EQ(ledger_->scheduler().points(), 3);
  EXPECT_EQ(ledger_->point(0).label, "peclet=10");
  EXPECT_EQ(ledger_->scheduler().begun(0), 1);  // what the point had when it stood elsewhere
  EXPECT_EQ(ask(file_as_it_is()), "set: nothing differs");
}

TEST_F(CarryingOut, AFileThatWasChangedSinceItWasCheckedIsNotTakenOver) {
  const TakeOver checked = file_as_it_is();
  document_["realisations"]["maximum"] = 90;
  write();
  EXPECT_TRUE(ask(checked).starts_with("set: left to what " + file().string() + " says since"));
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
  EXPECT_TRUE(answer(first).starts_with("set: left to what ")) << answer(first);
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
  EXPECT_EQ(ledger_->campaign().target.observable, "relative_viscosity");
  EXPECT_EQ(ledger_->scheduler().points(), 2);
}

TEST_F(CarryingOut, TheEngineOfARunIsNotChangedUnderIt) {
  document_["engine"] = {"another-engine"};
  write();
  ledger_->admit_engine(plain_engine());
  EXPECT_NE(ask(file_as_it_is()).find("/engine: [\"another-engine\"]: cannot be changed while"),
            std::string::npos);
  begin();  // nobody runs it
  EXPECT_EQ(ask(file_as_it_is()), "set: the file, in nothing that decides");
}

TEST_F(CarryingOut, ARunWithAnotherEngineDoesNotReopenWhatTheFirstOneDid) {
  for (int seed = 0; seed < 8; ++seed) store(0, seed, seed % 2 == 0 ? 10 : 10.5, "first");
  begin();
  ledger_->admit_engine(plain_engine("second"));  // the point is decided: nothing is mixed
  document_["target"]["relative_tolerance"] = 0.001;
  write();
  EXPECT_TRUE(
      ask(file_as_it_is()).starts_with("refused: peclet=1: has results of engine 1.0.0 (none) sha256"));
  EXPECT_TRUE(ledger_->scheduler().decided(0));
}

TEST_F(CarryingOut, APriorityDecidesWhoIsServedFirst) {
  EXPECT_EQ(ledger_->scheduler().next()->point, 0);
  EXPECT_EQ(ask(Prioritise{{"peclet=10"}, 5}), "set: priority 5: peclet=10");
  EXPECT_EQ(ledger_->scheduler().next()->point, 1);
  EXPECT_EQ(database_.points().at(1).priority, 5);
}

TEST_F(CarryingOut, ACancelledPointHoldsNothingUpUntilItIsTakenUpAgain) {
  EXPECT_EQ(ask(Cancel{{"peclet=1", hash(1).substr(0, 6)}, false}),
            "cancel: no more seeds: peclet=1, peclet=10");
  EXPECT_TRUE(ledger_->scheduler().finished());
  EXPECT_EQ(ask(Cancel{{"peclet=1"}, true}), "cancel: taken up again: peclet=1");
  EXPECT_FALSE(ledger_->scheduler().finished());
  EXPECT_EQ(ledger_->scheduler().next()->point, 0);
}

TEST_F(CarryingOut, APointThatNobodyKnowsIsRefusedWithTheNamesThatThereAre) {
  EXPECT_EQ(ask(Cancel{{"peclet=1", "peclet=7"}, false}),
            "refused: peclet=7: must be the label of one point, its values alone, or 4 or more digits of its "
            "hash; labels: peclet=1, "
            "peclet=10");
  EXPECT_FALSE(ledger_->scheduler().cancelled(0));
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
  EXPECT_EQ(database_.attempts(id(0)).size(), 3U);  // nothing is erased
  EXPECT_EQ(ask(Retry{{"peclet=1"}, {}}), "retry: no seed was given up: there is nothing to retry");
}

TEST_F(CarryingOut, ARetryMakesTheLooksAgainWithoutTheLoss) {
  for (int seed = 0; seed < 7; ++seed) store(0, seed, seed % 2 == 0 ? 10 : 10.5);
  crash_three_times(0, 7);
  begin();
  ASSERT_EQ(ledger_->scheduler().looks(0).back().verdict, Verdict::converged_with_losses);
  ask(Retry{{"peclet=1"}, {7}});
  EXPECT_TRUE(ledger_->scheduler().looks(0).empty());
  EXPECT_TRUE(database_.looks(id(0)).empty());
  EXPECT_EQ(ledger_->scheduler().begun(0), 7);
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
  EXPECT_FALSE(ledger_->scheduler().cancelled(0));
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

// Whatever bears the name of a request: nobody waits for it or follows it, and the next request is heard.
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
  fs::create_directories(folder / "5.json.rejected" / "full");  // where one would go
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

TEST_F(CarryingOut, AnEngineThatIsAcceptedStartsAfreshBesideTheOld) {
  for (int seed = 0; seed < 3; ++seed) store(0, seed, 10, "old");
  for (int seed = 0; seed < 8; ++seed) store(1, seed, seed % 2 == 0 ? 10 : 10.5, "old");
  PointStore(database_).set_priority(id(0), 4);
  begin();
  EXPECT_THROW(ledger_->admit_engine(plain_engine("new")), OtherEngine);
  write_durably(directory_.checkpoint(hash(0), 5), "of the old engine");
  const std::int64_t old_row = id(0);
  EXPECT_EQ(ledger_->accept_engine(engine_identity(plain_engine("new"))), 1);
  ledger_->admit_engine(plain_engine("new"));
  EXPECT_NE(id(0), old_row);
  EXPECT_EQ(database_.points().at(0).priority, 4);
  EXPECT_EQ(ledger_->scheduler().begun(0), 0);
  EXPECT_TRUE(ledger_->scheduler().decided(1));  // decided points stay as they are
  EXPECT_FALSE(fs::exists(directory_.checkpoint(hash(0), 5)));
  const std::vector<KeptApart> kept = database_.kept_apart(hash(0));
  ASSERT_EQ(kept.size(), 1U);
  EXPECT_EQ(kept[0].results, 3);
  EXPECT_EQ(kept[0].engine, engine_identity(plain_engine("old")));
  EXPECT_EQ(count("event WHERE kind = 'engine-accepted'"), 1);
  // Whoever looks at the point is told.
  const std::string results = "3 results of engine " + kept[0].engine;
  const CampaignStatus status = read_status(database_);
  EXPECT_NE(status_table(status).find("peclet=1: " + results + " are kept apart"), std::string::npos);
  EXPECT_EQ(status_json(status)["points"][0]["kept_apart"][0]["results"], 3);
  EXPECT_NE(explain(database_, directory_, "peclet=1").find("kept apart: " + results), std::string::npos);
  EXPECT_EQ(Json::parse(export_json(database_, false))["points"][0]["kept_apart"][0]["engine"],
            kept[0].engine);
  EXPECT_FALSE(Json::parse(export_json(database_, true))["points"][0].contains("kept_apart"));
}

TEST_F(CarryingOut, LateResultsOfTheOldEngineGoToItsOwnRow) {
  store(0, 0, 10, "old");
  begin();
  ledger_->accept_engine(engine_identity(plain_engine("new")));
  write_durably(directory_.spool_file(hash(0), 1, 3), plain_result(hash(0), 1, 11, "old").dump());
  write_durably(directory_.spool_file(hash(0), 2, 4), plain_result(hash(0), 2, 12, "new").dump());
  ledger_->ingest_spool();
  EXPECT_TRUE(fs::is_empty(directory_.rejected()));
  EXPECT_EQ(ledger_->scheduler().begun(0), 1);
  EXPECT_EQ(database_.outcomes(id(0)).at(2)->value, 12);
  EXPECT_EQ(database_.kept_apart(hash(0)).at(0).results, 2);
  begin();
  EXPECT_EQ(ledger_->scheduler().begun(0), 1);
  // Delivered once more, while the new engine is at that seed.
  write_durably(directory_.checkpoint(hash(0), 1), "of the new engine");
  const fs::path again = directory_.spool_file(hash(0), 1, 5);
  write_durably(again, plain_result(hash(0), 1, 11, "old").dump());
  ledger_->ingest_spool();
  EXPECT_FALSE(fs::exists(again));
  EXPECT_TRUE(fs::exists(directory_.checkpoint(hash(0), 1)));
}

TEST_F(CarryingOut, AnEngineThatWasReplacedIsRefusedEvenBeforeTheFirstResultOfTheOther) {
  store(0, 0, 10, "old");
  begin();
  ledger_->accept_engine(engine_identity(plain_engine("new")));
  begin();
  EXPECT_THROW(ledger_->admit_engine(plain_engine("old")), OtherEngine);
  ledger_->admit_engine(plain_engine("new"));
}

TEST_F(CarryingOut, AnEngineThatComesBackGoesOnWithWhatItHad) {
  for (int seed = 0; seed < 3; ++seed) store(0, seed, 10, "old");
  begin();
  const std::int64_t old_row = id(0);
  ledger_->accept_engine(engine_identity(plain_engine("new")));
  store(0, 0, 10, "new");
  begin();
  ledger_->accept_engine(engine_identity(plain_engine("old")));
  EXPECT_EQ(id(0), old_row);
  EXPECT_EQ(ledger_->scheduler().begun(0), 3);
  EXPECT_EQ(database_.kept_apart(hash(0)).at(0).engine, engine_identity(plain_engine("new")));
}

}  // namespace
}  // namespace peclet::runner
