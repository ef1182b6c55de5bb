#include "runner/store/blame.h"

#include <gtest/gtest.h>

#include <csignal>
#include <vector>

namespace peclet::runner {
namespace {

using enum AttemptOutcome;

SeedFate after(const std::vector<PastAttempt>& attempts) { return judge(attempts, 2); }

TEST(Blame, OnlyTheEnginesOwnDoingCounts) {
  for (const AttemptOutcome outcome : {crashed, hung, garbled, refused}) EXPECT_TRUE(is_blamed(outcome));
  for (const AttemptOutcome outcome : {running, result, drained, killed, abandoned})
    EXPECT_FALSE(is_blamed(outcome));
}

TEST(Blame, ASignalFromOutsideIsNotACrash) {
  for (const int signal : {SIGKILL, SIGTERM, SIGINT, SIGHUP}) EXPECT_EQ(outcome_of({{}, signal}), killed);
  for (const int signal : {SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL})
    EXPECT_EQ(outcome_of({{}, signal}), crashed);
}

TEST(Blame, AnyExitThatNobodyAskedForIsACrash) {
  for (const int status : {0, 1, 255}) EXPECT_EQ(outcome_of({status, {}}), crashed);
}

TEST(Blame, ASeedMayFailTwiceBeyondTheFirstTime) {
  EXPECT_FALSE(after({{crashed, 5}}).quarantine);
  EXPECT_FALSE(after({{crashed, 5}, {hung, 5}}).quarantine);
  const SeedFate third = after({{crashed, 5}, {hung, 5}, {garbled, 5}});
  EXPECT_TRUE(third.quarantine);
  EXPECT_EQ(third.cause, "garbled");
}

TEST(Blame, WhatOthersDoCostsNothing) {
  std::vector<PastAttempt> attempts{{crashed, 5}, {crashed, 5}};
  for (int i = 0; i < 100; ++i) {
    attempts.push_back({drained, 5});
    attempts.push_back({abandoned, 5});
    EXPECT_FALSE(after(attempts).quarantine);
  }
}

TEST(Blame, TwentyKillsInARowWithoutAStepForwardEndASeed) {
  std::vector<PastAttempt> attempts;
  for (int i = 0; i < 19; ++i) {
    attempts.push_back({killed, 7});
    attempts.push_back({abandoned, 7});
  }
  EXPECT_FALSE(after(attempts).quarantine);
  attempts.push_back({killed, 7});
  EXPECT_TRUE(after(attempts).quarantine);
  EXPECT_EQ(after(attempts).cause, "killed repeatedly");
}

TEST(Blame, KillsBetweenWhichTheSeedComesForwardNeverEndIt) {
  std::vector<PastAttempt> attempts;
  for (int step = 0; step < 500; ++step) {
    attempts.push_back({killed, step});
    EXPECT_FALSE(after(attempts).quarantine);
  }
}

TEST(Blame, ACheckpointThatMayBeTheCauseIsDiscarded) {
  EXPECT_FALSE(after({{crashed, 5}}).discard_checkpoint);
  EXPECT_TRUE(after({{refused, 5}}).discard_checkpoint);
  EXPECT_TRUE(after({{crashed, 5}, {crashed, 5}}).discard_checkpoint);
  EXPECT_FALSE(after({{crashed, 5}, {crashed, 5}, {killed, 6}}).discard_checkpoint);
}

TEST(Blame, InCompanyNothingCountsButTheCompanyIsHalved) {
  std::vector<PastAttempt> attempts;
  for (int deaths = 1; deaths < 10; ++deaths) {
    attempts.push_back({crashed, 5, true});
    EXPECT_FALSE(after(attempts).quarantine);
    EXPECT_FALSE(after(attempts).discard_checkpoint);
    EXPECT_EQ(halvings(attempts), deaths);
  }
  EXPECT_EQ(largest_company(100, 0), 100);
  EXPECT_EQ(largest_company(100, 3), 12);
  EXPECT_EQ(largest_company(100, 6), 1);
  EXPECT_EQ(largest_company(100'000, 31), 1);
}

TEST(Blame, EveryTwoKillsWithoutAStepForwardHalveTheCompany) {
  EXPECT_EQ(halvings(std::vector<PastAttempt>{{killed, 5}}), 0);
  EXPECT_EQ(halvings(std::vector<PastAttempt>{{killed, 5}, {drained, 5}, {killed, 5}}), 1);
  EXPECT_EQ(halvings(std::vector<PastAttempt>{{killed, 5}, {killed, 5}, {killed, 6}}), 0);
}

TEST(Blame, ASeedThatEndedItsEngineOnItsOwnStaysAlone) {
  EXPECT_EQ(largest_company(100'000, halvings(std::vector<PastAttempt>{{crashed, 5}})), 1);
  EXPECT_EQ(halvings(std::vector<PastAttempt>{{refused, 5}}), 0);  // its engine lives on
}

TEST(Blame, NamesOfOutcomesSurviveTheDatabase) {
  for (const AttemptOutcome outcome :
       {running, result, crashed, hung, garbled, refused, drained, killed, abandoned}) {
    EXPECT_EQ(attempt_outcome(to_string(outcome)), outcome);
  }
}

}  // namespace
}  // namespace peclet::runner
