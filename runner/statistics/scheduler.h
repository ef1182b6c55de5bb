// Which seed runs next, and when a point is decided. Pure: no clock, no process, no database.
//
// A point that is neither decided nor cancelled needs the seeds of its next stop test. Among such points
// those of the highest priority go first, and among these the one that the allocation ranks first (then the
// order of the sweep, then the order of the seeds). When every needed seed is out, workers run ahead with the
// seeds of the look after that: extra, which costs nothing when the point goes on, and which does not count
// when it stops.
//
// Under a budget no point runs ahead of its next stop test, and a seed is given out only while the expected
// cost of what runs is within what is left. Under a ceiling only the first seeds of each point are given out.
//
// Priorities, costs and the allocation decide when a seed runs; what it counts for they cannot touch.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runner/statistics/cohorts.h"

namespace peclet::runner {

// `point` is the index in the order of the sweep.
struct SeedId {
  int point = 0;
  int seed = 0;
  friend bool operator==(const SeedId&, const SeedId&) = default;
};

enum class Allocation {
  // First a pass over all points: the one with fewest begun seeds goes first, and among these the cheapest,
  // until each has seeds_of_pass, so that something is soon known of all. Then the point with the largest
  // cost still to come, seeds that it is expected to need times seconds of each: a campaign is through the
  // sooner the earlier its longest point is begun.
  longest_first,
  // The point whose half-width w, as a share of the tolerance, will fall most, for a second of processor
  // time, by its next stop test:
  //   w (1 - t(n' - 1) sqrt(n) / (t(n - 1) sqrt(n'))) / (seeds still to be begun * seconds of each)
  // with n values now and n' then. What is begun counts only when its stop test is reached, so a stop test
  // once begun
  // is seen through. Points without a stop test come before, the cheapest first. For a budget that will not
  // see
  // all points converged.
  steepest_first
};

class Scheduler {
 public:
  // As many as `peclet plan --pilot` begins with: a mean with an error, and what a seed costs. The longest
  // point is hardly held up, because its own seeds are part of the pass.
  static constexpr int seeds_of_pass = 4;

  // `outcomes[point][seed]` is what earlier runs left; seeds beyond the end have none.
  Scheduler(std::vector<std::vector<std::optional<Outcome>>> outcomes, Target target, int minimum,
            int maximum);

  void set_allocation(Allocation allocation) { allocation_ = allocation; }
  void set_priority(int point, int priority) { point_at(point).priority = priority; }
  // A cancelled point gets no more seeds and holds nothing up. What it has stays.
  void set_cancelled(int point, bool cancelled) { point_at(point).cancelled = cancelled; }
  // Mean seconds of a realisation of the point, as far as it is known; until then it costs as much as its
  // share of the work says, beside the others.
  void set_cost(int point, double seconds) { point_at(point).seconds = seconds; }
  // Work of a realisation in any unit (particle-steps) that is the same for all points; 1 unless set.
  void set_work(int point, double work) { point_at(point).work = work; }
  // Only the seeds 0 .. ceiling - 1 of each point are wanted.
  void set_ceiling(int ceiling) { ceiling_ = ceiling; }

  // The next seed for an idle worker; nothing when every seed that could be wanted now is out or ended.
  std::optional<SeedId> next() const;
  // The same under a budget of which so many seconds are left: a seed that a stop test needs and that is
  // expected to cost no more, if possible of a stop test that can be paid for as a whole. While no cost is
  // known at all every seed is expected to cost nothing.
  std::optional<SeedId> next_within(double seconds) const;
  // Of seeds that are out, so many of each point; 0 while no cost is known at all.
  double expected_seconds(const std::vector<int>& running) const;

  // The seed has been given to a worker.
  void begin(SeedId id);
  // The seed has come back without an outcome.
  void give_back(SeedId id);
  // The seed has ended, for the first time or (a late result of a quarantined seed) for the second.
  // True when the stop tests of its point may have changed.
  bool end(SeedId id, const Outcome& outcome);

  // All stop tests that the outcomes allow. The last one decides unless its verdict is `more`.
  const std::vector<StopTest>& stop_tests(int point) const { return point_at(point).stop_tests; }
  bool decided(int point) const;
  bool cancelled(int point) const { return point_at(point).cancelled; }
  // Every point is decided or cancelled, or has all seeds below the ceiling.
  bool finished() const;

  // Seeds that the next stop test needs, or the ceiling allows; of a decided point those of the deciding stop
  // test.
  int wanted(int point) const;
  // Of these, how many have ended.
  int ended(int point) const;
  // Values (observable + control) of the seeds that have ended, in whatever order they came; of
  // Target::observables(), in that order.
  std::vector<Estimate> all_seeds(int point) const;
  // Seeds of the point that run or have ended.
  int begun(int point) const { return point_at(point).begun; }
  // Of these, those that have ended.
  int all_ended(int point) const { return point_at(point).all_ended; }
  const Target& target() const { return target_; }
  int points() const { return static_cast<int>(points_.size()); }

 private:
  // How one seed stands; one that nothing is known of waits.
  enum class Phase : unsigned char { waiting, out, ended };
  struct Point {
    std::vector<StopTest> stop_tests{};
    int begun = 0;  // out or ended
    int all_ended = 0;
    std::vector<RunningEstimate> all_seeds{};  // of each observable
    int closed = 0;                            // the seeds 0 .. closed - 1 have ended
    int expected = 0;                          // seeds at which it may be expected to stop
    double fall = 0;  // of the half-width until the next stop test, as a share of the tolerance
    std::optional<double> seconds{};
    // As long as the largest seed that is known asks for, because the maximum may be far beyond what the
    // point will ever need: later seeds wait, and have no outcome.
    std::vector<std::optional<Outcome>> outcomes{};
    std::vector<Phase> phases{};
    int priority = 0;
    bool cancelled = false;
    double work = 1;
  };
  const Point& point_at(int point) const { return points_[static_cast<std::size_t>(point)]; }
  Point& point_at(int point) { return points_[static_cast<std::size_t>(point)]; }
  // Makes room for the seed. Throws std::out_of_range for one beyond the maximum.
  Phase& phase_of(SeedId id);
  static void close(Point& point);
  void stop_test_at(Point& point);
  static void count_in(Point& point, const Outcome& outcome);
  // The look after the last one made, and the one after that.
  int stop_test_ahead(const Point& point, int steps) const;
  bool is_open(const Point& point) const;
  // Of the points whose cost is known; nothing when there is none.
  std::optional<double> seconds_per_work() const;
  // How urgent the point is; the largest goes first.
  struct Rank {
    int pass = 0;  // seeds that it lacks of the first pass
    double urgency = 0;
    auto operator<=>(const Rank&) const = default;
  };
  Rank rank(const Point& point, double seconds) const;
  double expected_fall(const Point& point) const;
  // Seeds of the next stop test that nobody has begun.
  int waiting(const Point& point) const;
  // The first of them, or of those of `steps` looks further.
  std::optional<int> waiting_seed(const Point& point, int steps) const;
  // Of the seeds that a stop test so many steps ahead is still waiting for, those that `phases` tells of, and
  // how many follow.
  struct Stretch {
    std::span<const Phase> known;
    int beyond = 0;
  };
  Stretch still_open(const Point& point, int steps) const;
  std::optional<SeedId> most_urgent(int steps, double budget) const;

  Target target_;
  int minimum_, maximum_, ceiling_;
  std::vector<int> schedule_;
  Allocation allocation_ = Allocation::longest_first;
  std::vector<Point> points_;
};

// What a run under a budget of processor time has bought.

// Relative half-widths of the last stop tests, summed over the points that are not cancelled; of no point
// where the tolerance is absolute. One that has no stop test, or none with an interval, counts as 1: its mean
// is not known at all.
struct SummedError {
  double sum = 0;
  int points = 0, unknown = 0;
};
SummedError summed_error(const Scheduler& scheduler);

// "budget: 1.98 of 2 h of processor time spent; the relative half-widths of 6 points sum to 0.31, before to
// 2.4 (2 points without a stop test count as 1)"
std::string budget_text(double spent_seconds, double budget_seconds, const SummedError& before,
                        const SummedError& after);

}  // namespace peclet::runner
