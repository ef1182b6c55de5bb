#include <gtest/gtest.h>

#include <cmath>

#include "engine/state/threads.h"

namespace peclet::engine {
namespace {

TEST(Team, SharesOutEverythingOnce) {
  for (const int threads : {1, 2, 3, 5}) {
    for (const std::size_t count : {0U, 1U, 4U, 17U}) {
      std::vector<int> taken(count);
      run_team(threads, [&](Team& team) {
        const Team::Part mine = team.part_of(count);
        for (std::size_t i = mine.begin; i < mine.end; ++i) ++taken[i];
      });
      EXPECT_EQ(taken, std::vector<int>(count, 1)) << threads;
    }
  }
}

// Each round sums both neighbours of the previous round, computed by other members: expected 2^rounds.
TEST(Team, SeesWhatOthersDidBeforeTheyArrived) {
  constexpr std::size_t count = 12;
  constexpr int rounds = 50;
  for (const int threads : {1, 2, 3, 5}) {
    std::vector<double> places[2] = {std::vector<double>(count, 1), std::vector<double>(count)};
    run_team(threads, [&](Team& team) {
      const Team::Part mine = team.part_of(count);
      for (int round = 0; round < rounds; ++round) {
        const std::vector<double>& from = places[round % 2];
        team.wait();
        for (std::size_t i = mine.begin; i < mine.end; ++i) {
          places[1 - round % 2][i] = from[(i + 1) % count] + from[(i + count - 1) % count];
        }
        team.arrive();
      }
    });
    EXPECT_EQ(places[0], std::vector<double>(count, std::ldexp(1.0, rounds))) << threads;
  }
}

TEST(Team, HasOneFirstMember) {
  std::atomic<int> first = 0, members = 0;
  run_team(3, [&](Team& team) {
    ++members;
    first += team.is_first() ? 1 : 0;
  });
  EXPECT_EQ(members, 3);
  EXPECT_EQ(first, 1);
}

}  // namespace
}  // namespace peclet::engine
