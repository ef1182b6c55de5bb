
#include "runner/store/result_store.h"

#include <gtest/gtest.h>

#include <cmath>

#include "contract/errors.h"
#include "runner/store/point_store.h"
#include "runner/store/seed_store.h"
#include "tests/runner/runner_fixture.h"

namespace peclet::runner {
namespace {

class Stores : public testing::Test {
 protected:
  Stores() { PointStore(database_).adopt(campaign_); }

  Stored offer(const Json& result) {
    return ResultStore(database_).store(parse_result(result.dump()), campaign_.target).what;
  }
  const std::string& hash(int point = 0) const {
    return campaign_.points[static_cast<std::size_t>(point)].hash;
  }
  double value() { return std::stod(seen("value")); }
  // Returns a column of the view `realisations` for the first seed; "" for NULL.
  std::string seen(const std::string& column) {
    return database_.connection().text("SELECT " + column + " FROM realisations");
  }
  std::int64_t begin(int seed) {
    return SeedStore(database_).begin_attempt(1, seed, 0, 4711, engine_row(database_, plain_engine()));
  }

  TemporaryFolder folder_;
  Campaign campaign_ = plain_campaign(2, 4, 40, 0.05);
  Database database_ = Database::open_owner(folder_.path() / "campaign.db");
};

TEST_F(Stores, AResultIsStoredWholeAndInColumns) {
  const Json result = plain_result(hash(), 3, 12.5);
  EXPECT_EQ(offer(result), Stored::stored);
  const RealisationRecord record = database_.realisations(1).at(0);
  EXPECT_EQ(record.seed, 3);
  EXPECT_EQ(record.state, SeedState::done);
  EXPECT_EQ(seen("value"), "12.5");
  EXPECT_EQ(seen("control"), "0.25");
  EXPECT_EQ(seen("first_half"), "12.75");
  EXPECT_EQ(record.cpu_seconds, 2.0);
  EXPECT_EQ(database_.result(1, 3), result);
  EXPECT_EQ(database_.connection().integer("SELECT count(*) FROM realisations WHERE label = 'point=0'"), 1);
}

TEST_F(Stores, ABlowUpIsAnOutcomeAndNeverANumber) {
  Json result = plain_result(hash(), 0, 12.5);
  result["ending"]["cause"] = "overlap";
  result["mean"] = result["blocks"] = nullptr;
  EXPECT_EQ(offer(result), Stored::stored);
  EXPECT_EQ(database_.realisations(1).at(0).state, SeedState::failed);
  EXPECT_EQ(seen("value"), "");
  EXPECT_TRUE(database_.outcomes(1).at(0)->is_lost());
}

TEST_F(Stores, WhatElseATargetAimsAtIsKept) {
  campaign_.target.also = {{"pressure", Tolerance::absolute(1)}, {"temperature", 0.1}};
  PointStore(database_).adopt(campaign_);
  Json result = plain_result(hash(), 0, 12.5);
  result["mean"]["temperature"] = nullptr;
  result["blocks"]["pressure"] = {30, 20, 20, 30};
  offer(result);
  const Outcome outcome = database_.outcomes(1).at(0).value();
  EXPECT_EQ(outcome.value, 12.5);
  ASSERT_EQ(outcome.further.size(), 2U);
  EXPECT_EQ(outcome.further[0].value, 25);
  EXPECT_EQ(outcome.further[0].control, 0);
  EXPECT_EQ(outcome.further[0].first_quarter, 30);
  EXPECT_EQ(outcome.further[0].first_half, 25);
  EXPECT_TRUE(std::isnan(outcome.further[1].value));
}

TEST_F(Stores, WhatATargetAimsAtNewlyIsTakenFromTheResultsThatAreThere) {
  offer(plain_result(hash(), 0, 12.5));
  EXPECT_TRUE(database_.outcomes(1).at(0)->further.empty());
  campaign_.target.tolerance.relative_to = "pressure";
  PointStore(database_).adopt(campaign_);
  ASSERT_EQ(database_.outcomes(1).at(0)->further.size(), 1U);
  EXPECT_EQ(database_.outcomes(1).at(0)->further[0].value, 25);
  EXPECT_EQ(database_.campaign().target.target, campaign_.target);
  campaign_.target.also = {{"vorticity", 0.1}};
  try {
    PointStore(database_).adopt(campaign_);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.pointer(), "/target/also/0/observable");
    EXPECT_EQ(error.value(), "vorticity");
  }
  EXPECT_EQ(database_.outcomes(1).at(0)->further[0].value, 25);
}

TEST_F(Stores, ADuplicateCountsOnce) {
  Json result = plain_result(hash(), 3, 12.5);
  offer(result);
  result["cost"]["cpu_seconds"] = 77.0;
  EXPECT_EQ(offer(result), Stored::duplicate);
  EXPECT_EQ(database_.counts(1).done, 1);
  EXPECT_EQ(database_.realisations(1).at(0).cpu_seconds, 2.0);
}

TEST_F(Stores, ADifferentResultOfTheSameSeedMakesThePointSuspect) {
  offer(plain_result(hash(), 3, 12.5));
  EXPECT_EQ(offer(plain_result(hash(), 3, 12.6)), Stored::conflict);
  EXPECT_TRUE(database_.points().at(0).suspect);
  EXPECT_FALSE(database_.points().at(1).suspect);
  EXPECT_EQ(value(), 12.5);
  EXPECT_EQ(database_.events(1).at(0).kind, "suspect");
}

TEST_F(Stores, OnePointNeverMixesTwoEngines) {
  offer(plain_result(hash(), 0, 12.5, "old"));
  EXPECT_EQ(offer(plain_result(hash(), 1, 12.5, "new")), Stored::mixed_engine);
  EXPECT_EQ(offer(plain_result(hash(1), 1, 12.5, "new")), Stored::stored);
  EXPECT_EQ(database_.counts(1).done, 1);
}

TEST_F(Stores, AResultOfAnUnknownPointIsNotTaken) {
  EXPECT_EQ(offer(plain_result(std::string(64, 'f'), 0, 12.5)), Stored::unknown_point);
}

TEST_F(Stores, ProvenanceIsStoredOnce) {
  const std::string long_flags(1000, '-');
  for (int seed = 0; seed < 5; ++seed) {
    Json result = plain_result(hash(), seed, 12.5);
    result["engine"]["flags"] = long_flags;
    offer(result);
    EXPECT_EQ(database_.result_text(1, seed), result.dump());
  }
  EXPECT_EQ(database_.engines().size(), 1U);
  // The text of a result is little more than a reference to the first one.
  EXPECT_LT(database_.connection().integer("SELECT max(length(document)) FROM result"), 200);
}

TEST_F(Stores, SeedsOfADeadOwnerAreQueuedAgainWithoutBlame) {
  begin(2);
  begin(3);
  EXPECT_EQ(SeedStore(database_).recover(), 2);
  EXPECT_EQ(database_.counts(1).queued, 2);
  EXPECT_TRUE(database_.leases(1).empty());
  EXPECT_EQ(database_.attempts(1).at(0).outcome, "abandoned");
  EXPECT_FALSE(database_.attempts(1).at(0).blamed);
  EXPECT_EQ(SeedStore(database_).recover(), 0);
}

TEST_F(Stores, AttemptsKeepTheirCause) {
  const std::int64_t attempt = begin(2);
  EXPECT_EQ(database_.leases(1).at(0).phase, "starting");
  SeedStore(database_).renew_lease(attempt, "production", 50, 100, 0.5);
  EXPECT_EQ(database_.leases(1).at(0).step, 50);
  SeedStore(database_).end_attempt(attempt, {AttemptOutcome::crashed, 57, {{}, 11}, "signal 11"});
  SeedStore(database_).requeue(1, 2);
  EXPECT_TRUE(database_.leases(1).empty());
  const AttemptRecord record = database_.attempts(1).at(0);
  EXPECT_EQ(record.outcome, "crashed");
  EXPECT_TRUE(record.blamed);
  EXPECT_EQ(record.signal, 11);
  EXPECT_EQ(record.exit_status, std::nullopt);
  EXPECT_EQ(record.step, 57);
  EXPECT_EQ(database_.counts(1).queued, 1);
}

TEST_F(Stores, ALateResultLiftsAQuarantine) {
  begin(2);
  SeedStore(database_).quarantine(1, 2, "hung");
  EXPECT_TRUE(database_.outcomes(1).at(2)->is_lost());
  EXPECT_EQ(offer(plain_result(hash(), 2, 12.5)), Stored::stored);
  EXPECT_FALSE(database_.outcomes(1).at(2)->is_lost());
}

TEST_F(Stores, PointsThatLeaveTheSweepStayAndComeBack) {
  offer(plain_result(hash(1), 0, 12.5));
  PointStore(database_).adopt(plain_campaign(1, 4, 40, 0.05));
  EXPECT_EQ(database_.points().size(), 1U);
  ASSERT_EQ(database_.inactive_points().size(), 1U);
  EXPECT_EQ(database_.inactive_points().at(0).hash, hash(1));
  PointStore(database_).adopt(plain_campaign(3, 4, 40, 0.05));
  ASSERT_EQ(database_.points().size(), 3U);
  EXPECT_EQ(database_.counts(database_.points().at(1).id).done, 1);
}

TEST_F(Stores, StopTestsOfAnOlderTargetStayInTheHistory) {
  StopTest stop_test;
  stop_test.seeds = 4;
  stop_test.estimate = {4, 12, 0.1};
  stop_test.half_width = 0.3;
  stop_test.verdict = Verdict::converged;
  ResultStore(database_).store_stop_tests(1, {stop_test});
  PointStore(database_).adopt(plain_campaign(2, 4, 40, 0.01));
  EXPECT_TRUE(database_.stop_tests(1).empty());
  PointStore(database_).adopt(plain_campaign(2, 4, 40, 0.05));
  ASSERT_EQ(database_.stop_tests(1).size(), 1U);
  EXPECT_EQ(database_.stop_tests(1)[0].target.target.tolerance, Tolerance(0.05));
}

TEST_F(Stores, AnotherObservableIsTakenFromTheResultsThatAreThere) {
  offer(plain_result(hash(), 0, 12.5));
  Campaign other = campaign_;
  other.target.observable = "pressure";
  PointStore(database_).adopt(other);
  EXPECT_EQ(value(), 25);
  EXPECT_EQ(seen("control"), "");
}

TEST_F(Stores, ACompletedSeedWithoutTheNumberIsLostUntilAnotherObservableFindsIt) {
  Json result = plain_result(hash(), 0, 12.5);
  result["mean"]["relative_viscosity"] = nullptr;
  EXPECT_EQ(offer(result), Stored::stored);
  EXPECT_EQ(database_.realisations(1).at(0).state, SeedState::failed);
  EXPECT_EQ(database_.realisations(1).at(0).cause, "no-value");
  EXPECT_TRUE(database_.outcomes(1).at(0)->is_lost());
  Campaign other = campaign_;
  other.target.observable = "pressure";
  PointStore(database_).adopt(other);
  EXPECT_EQ(database_.realisations(1).at(0).state, SeedState::done);
  EXPECT_EQ(database_.realisations(1).at(0).cause, "completed");
  EXPECT_EQ(value(), 25);
  PointStore(database_).adopt(campaign_);
  EXPECT_EQ(database_.realisations(1).at(0).state, SeedState::failed);
}

TEST_F(Stores, ResultsSetAsideNeedNotHaveAnotherObservable) {
  Json bare = plain_result(hash(), 0, 12.5, "old");
  bare["mean"].erase("pressure");
  offer(bare);
  PointStore(database_).set_aside(database_.points().at(0), engine_identity(plain_engine("new")));
  Campaign other = campaign_;
  other.target.observable = "pressure";
  PointStore(database_).adopt(other);
  EXPECT_EQ(database_.campaign().target.target.observable, "pressure");
}

TEST_F(Stores, AnObservableThatResultsLackChangesNothing) {
  offer(plain_result(hash(), 0, 12.5));
  // The second is there, but is not a number.
  for (const char* const name : {"colour", "control_variates"}) {
    Campaign other = campaign_;
    other.target.observable = name;
    EXPECT_THROW(PointStore(database_).adopt(other), InputError) << name;
    EXPECT_EQ(database_.campaign().target.target.observable, "relative_viscosity") << name;
    EXPECT_EQ(value(), 12.5) << name;
  }
}

}  // namespace
}  // namespace peclet::runner
