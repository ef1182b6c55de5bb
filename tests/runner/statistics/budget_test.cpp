// Tests runs with a budget of processor time.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "runner/campaign/number_text.h"
#include "runner/statistics/scheduler.h"
#include "runner/store/database_summary.h"
#include "tests/runner/campaign_process.h"

namespace peclet::runner {
namespace {

constexpr double seconds_per_hour = 3600;

struct Spending {
  double total = 0, largest = 0;  // seconds of all results, and of the most expensive one
};

Spending spending(const CampaignOnDisk& campaign) {
  Database database = campaign.reader();
  Spending spent;
  for (const PointRecord& point : database.points()) {
    for (const RealisationRecord& record : database.realisations(point.id)) {
      spent.total += record.cpu_seconds.value_or(0);
      spent.largest = std::max(spent.largest, record.cpu_seconds.value_or(0));
    }
  }
  return spent;
}

// Sets a tolerance that needs more seeds than any budget here pays for.
void ask_for_much(CampaignOnDisk& campaign) {
  campaign.document["target"]["relative_tolerance"] = 0.001;
  campaign.document["realisations"] = {{"minimum", 8}, {"maximum", 10'000}};
}

TEST(Budget, IsKeptToWithinOneSeedOfEveryWorker) {
  const Environment seeds_of_a_tenth_of_a_second{{"PECLET_FAKE_STEP_MS", "10"}};
  CampaignOnDisk campaign(3);
  ask_for_much(campaign);
  double before = 0;
  for (const double budget : {2.0, 1.5}) {  // the second run continues the first one
    campaign.options.budget_hours = budget / seconds_per_hour;
    EXPECT_EQ(campaign.run(seeds_of_a_tenth_of_a_second), 75) << campaign.log();
    const Spending spent = spending(campaign);
    EXPECT_LE(spent.total - before, budget + campaign.options.workers * spent.largest);
    EXPECT_GE(spent.total - before, budget - campaign.options.workers * spent.largest);
    before = spent.total;
  }
  EXPECT_NE(campaign.log().find("of processor time spent"), std::string::npos) << campaign.log();
  Database database = campaign.reader();
  for (const PointSummary& point : summarise_points(database, database.campaign().target)) {
    EXPECT_LE(point.counts.terminal(), point.wanted) << "no point runs ahead";
  }
}

TEST(Budget, ThatIsLargeEnoughIsARunAsAnyOther) {
  CampaignOnDisk unlimited(2);
  ASSERT_EQ(unlimited.run(), 0) << unlimited.log();
  CampaignOnDisk campaign(2);
  campaign.options.budget_hours = 1;
  EXPECT_EQ(campaign.run(), 0) << campaign.log();
  EXPECT_EQ(campaign.answer(), unlimited.answer());
}

// Each attempt hangs for the 0.5 s of its lease and gives no result. The first one leaves 0.3 s. The cost of
// a seed is still unknown, so there is a second attempt; then no budget is left.
TEST(Budget, AttemptsWithoutAResultAreSpent) {
  CampaignOnDisk campaign(3);
  campaign.options.workers = 1;
  campaign.options.lease_seconds = 0.5;
  campaign.options.budget_hours = 0.8 / seconds_per_hour;
  EXPECT_EQ(campaign.run({{"PECLET_FAKE_FAULTS", "hang:0 hang:1 hang:2"}}), 75) << campaign.log();
  EXPECT_GE(campaign.count("SELECT count(*) FROM attempt WHERE outcome = 'hung'"), 1);
  EXPECT_LE(campaign.count("SELECT count(*) FROM attempt"), 2);
}

// At 1 - 0.05 (1 - 1.4 / 4) = 96.75 %, t(3) = 3.777. For four values 10 +- 0.1 the relative half-width is
// 3.777 * 0.01 / sqrt(3) = 2.2 %.
TEST(Budget, SaysWhatItBought) {
  Scheduler scheduler(std::vector<std::vector<std::optional<Outcome>>>(2), {"relative_viscosity", 0.05, 0.95},
                      4, 40);
  const SummedError before = summed_error(scheduler);
  EXPECT_EQ(before.sum, 2);
  EXPECT_EQ(before.unknown, 2);
  for (int seed = 0; seed < 4; ++seed) {
    scheduler.begin({0, seed});
    scheduler.end({0, seed}, {{seed % 2 == 0 ? 9.9 : 10.1}});
  }
  const SummedError after = summed_error(scheduler);
  EXPECT_NEAR(after.sum, 1.0218, 1e-4);
  EXPECT_EQ(after.unknown, 1);
  EXPECT_EQ(
      budget_text(1800, 3600, before, after),
      "budget: 0.5 of 1 h of processor time spent; at the last stop tests the relative half-widths of 2 "
      "points sum to 1.02 (1 of them without an interval, each counted as 1),\n        before the run to 2 "
      "(2 of them without an interval, each counted as 1)\n");
}

TEST(Budget, SumsNoRelativeErrorsWhereTheToleranceIsAbsolute) {
  const Scheduler scheduler(std::vector<std::vector<std::optional<Outcome>>>(2),
                            {"N1", Tolerance::absolute(0.1), 0.95}, 4, 40);
  EXPECT_EQ(budget_text(1800, 3600, summed_error(scheduler), summed_error(scheduler)),
            "budget: 0.5 of 1 h of processor time spent\n");
}

// Two points have equal costs: one has a half-width of 20 %, the other a mean of 0 without an interval. The
// latter goes first, although 20 % is far from the tolerance.
TEST(Budget, AMeanWithoutAnIntervalComesBeforeOneThatIsPoorlyKnown) {
  std::vector<std::optional<Outcome>> poor, unknown(4, Outcome{});
  for (int seed = 0; seed < 4; ++seed) poor.emplace_back(Outcome{{seed % 2 == 0 ? 9.0 : 11}});
  unknown[0] = unknown[1] = Outcome{{1}};
  unknown[1]->value = -1;
  Scheduler scheduler({poor, unknown}, {"relative_viscosity", 0.05, 0.95}, 4, 4000);
  scheduler.set_allocation(Allocation::steepest_first);
  for (int point = 0; point < 2; ++point) scheduler.set_cost(point, 1);
  EXPECT_EQ(scheduler.next_within(1000)->point, 1);
}

// Returns the summed error after a run with one worker, for normal populations of mean 1 whose spreads and
// costs differ by a factor of ten.
double error_bought(Allocation allocation, double budget, unsigned start) {
  const std::vector<double> spreads{0.05, 0.5, 0.05, 0.5}, seconds{1, 1, 10, 10};
  std::mt19937_64 random(start);
  Scheduler scheduler(std::vector<std::vector<std::optional<Outcome>>>(4), {"relative_viscosity", 0.03, 0.95},
                      8, 4000);
  scheduler.set_allocation(allocation);
  for (int point = 0; point < 4; ++point) scheduler.set_cost(point, seconds[static_cast<std::size_t>(point)]);
  while (const std::optional<SeedId> next = scheduler.next_within(budget)) {
    const auto point = static_cast<std::size_t>(next->point);
    scheduler.begin(*next);
    scheduler.end(*next, {{std::normal_distribution<double>(1, spreads[point])(random)}});
    budget -= seconds[point];
  }
  return summed_error(scheduler).sum;
}

// All points would take about 12 000 s. By chance, all 40 pairs have the same order once in 10^12 cases.
TEST(Budget, SteepestFirstBuysASmallerErrorThanLongestFirst) {
  for (unsigned start = 0; start < 40; ++start) {
    EXPECT_LT(error_bought(Allocation::steepest_first, 2000, start),
              error_bought(Allocation::longest_first, 2000, start))
        << start;
  }
}

}  // namespace
}  // namespace peclet::runner
