// Chooses the seed that runs next, and decides when a point is done. Pure: no clock, no process, no database.
//
// A point that is neither decided nor cancelled needs the seeds of its next stop test, but for a point of a
// curve that waits for the others (curve_stop_tests.h). Points of the highest priority go first; among them
// the one that the allocation ranks first, then the order of the sweep and of the seeds. If every needed seed
// runs, workers run ahead with seeds of the stop test after the next one. If the next one decides the point,
// these are extra seeds and do not count.
//
// Under a budget no point runs ahead of its next stop test, and a seed is given out only if its expected cost
// is within the budget left. Under a ceiling only the first seeds of each point are given out.
//
// Priorities, costs and the allocation decide when a seed runs. They never affect the stop tests.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runner/statistics/cohorts.h"
#include "runner/statistics/curve_stop_tests.h"

namespace peclet::runner {

// A seed of a point; `point` is the index in the order of the sweep.
struct SeedId {
  int point = 0;
  int seed = 0;
  friend bool operator==(const SeedId&, const SeedId&) = default;
};

enum class Allocation {
  // A first pass gives seeds_of_pass seeds to each point, so that something is soon known of all: the point
  // with the fewest begun seeds goes first, among these the cheapest. Then the point with the largest
  // remaining cost goes first: expected seeds to begin times seconds of each. A campaign ends sooner if its
  // longest point begins early.
  longest_first,
  // The point goes first whose half-width w, over the tolerance, falls most per second of processor time by
  // its next stop test:
  //   w (1 - t(n' - 1) sqrt(n) / (t(n - 1) sqrt(n'))) / (seeds still to be begun * seconds of each)
  // with n values now, n' then, and Student's quantile t. Seeds count only at their stop test, so one that
  // has begun is completed first. Points before their first stop test precede all others, the cheapest first.
  // This is for a budget that is too small for all points to converge.
  steepest_first
};

// A point whose stop tests may have changed, and what was known of it before.
struct Change {
  int point = 0;
  std::size_t stop_tests = 0;
  bool decided = false;
};

class Scheduler {
 public:
  // The first seeds of `peclet plan --pilot`: they give a mean with an error, and the cost of a seed. The
  // pass hardly delays the longest point, whose own seeds are part of it.
  static constexpr int seeds_of_pass = 4;

  // `outcomes[point][seed]` is known from earlier runs; seeds beyond the end have no outcome.
  // The curves must be those of a target with a curve, and have each point once.
  Scheduler(std::vector<std::vector<std::optional<Outcome>>> outcomes, Target target, int minimum,
            int maximum, std::vector<Curve> curves = {});

  void set_allocation(Allocation allocation) { allocation_ = allocation; }
  void set_priority(int point, int priority) { point_at(point).priority = priority; }
  // A cancelled point gets no more seeds and delays nothing. Its outcomes stay. Points of its curve that
  // waited for it do so no longer.
  void set_cancelled(int point, bool cancelled);
  // Sets the mean cost of a realisation [s]. Until then it follows from the work, at the mean seconds per
  // work of the other points.
  void set_cost(int point, double seconds) { point_at(point).seconds = seconds; }
  // Sets the work of a realisation, in a unit common to all points (particle-steps); 1 unless set.
  void set_work(int point, double work) { point_at(point).work = work; }
  // Restricts each point to the seeds 0 .. ceiling - 1.
  void set_ceiling(int ceiling) { ceiling_ = ceiling; }

  // Says whether a seed may run where a seed is looked for. An empty function allows all.
  using Allows = std::function<bool(SeedId)>;
  // Returns the next seed for a worker; nothing if all seeds that may run now run or have ended.
  std::optional<SeedId> next(const Allows& allows = {}) const;
  // Returns the next seed under a budget with `seconds` left: one that the next stop test of its point needs
  // and that is expected to cost no more. Stop tests that the budget can pay as a whole go first. While no
  // cost is known, every seed is expected to cost nothing.
  std::optional<SeedId> next_within(double seconds, const Allows& allows = {}) const;
  // Returns true if next() could return the seed, or next_within() with this budget [s].
  bool may_be_next(SeedId id, std::optional<double> budget) const;
  // Returns the expected cost of the running seeds [s], running[p] of each point p; 0 while no cost is known.
  double expected_seconds(const std::vector<int>& running) const;

  // Records that a worker has the seed.
  void begin(SeedId id);
  // Records that a worker gave the seed back without an outcome; it may be given out again.
  void give_back(SeedId id);
  // Records that the seed has ended, for the first time or again (late result of a quarantined seed). Returns
  // the points whose stop tests may have changed: its own, or all of its curve.
  std::vector<Change> end(SeedId id, const Outcome& outcome);

  // Returns all stop tests that the outcomes allow. The last one decides unless its verdict is `more`.
  const std::vector<StopTest>& stop_tests(int point) const { return point_at(point).stop_tests; }
  bool decided(int point) const;
  bool cancelled(int point) const { return point_at(point).cancelled; }
  // True if the point needs no seeds until other points of its curve have made their stop tests.
  bool is_waiting(int point) const { return is_waiting(point_at(point)); }
  // Returns the steps times the spheres of a realisation of a point on a curve; 0 if unknown.
  double work_on_curve(int point) const {
    const Point& about = point_at(point);
    return curves_[about.curve.value()].stop_tests.work(about.member);
  }
  // Returns true if every point is decided or cancelled, or all its seeds below the ceiling have ended.
  bool finished() const;

  // Returns the number of seeds of the next stop test, or the ceiling if that is less; for a decided point,
  // the seeds of the deciding stop test, and for a waiting one those of its last stop test.
  int wanted(int point) const;
  // Returns how many of the wanted() seeds have ended.
  int ended(int point) const;
  // Returns the estimates of observable + control over all ended seeds, ordered as Target::observables().
  std::vector<Estimate> all_seeds(int point) const;
  // Returns the number of seeds of the point that run or have ended.
  int begun(int point) const { return point_at(point).begun; }
  // Returns how many seeds of the point have ended.
  int all_ended(int point) const { return point_at(point).all_ended; }
  const Target& target() const { return target_; }
  int points() const { return static_cast<int>(points_.size()); }

 private:
  // The state of a seed; `out` means that a worker has it.
  enum class Phase : unsigned char { waiting, out, ended };
  struct Point {
    std::vector<StopTest> stop_tests{};
    int begun = 0;  // out or ended
    int all_ended = 0;
    std::vector<RunningEstimate> all_seeds{};  // of each observable
    int closed = 0;                            // the seeds 0 .. closed - 1 have ended
    int expected = 0;                          // seeds at which it is expected to stop
    double fall = 0;  // expected fall of half-width over tolerance until the next stop test
    std::optional<double> seconds{};
    // Both lists end at the largest known seed, because the maximum may be far beyond what the point needs.
    // Later seeds are waiting.
    std::vector<std::optional<Outcome>> outcomes{};
    std::vector<Phase> phases{};
    int priority = 0;
    bool cancelled = false;
    double work = 1;
    std::optional<std::size_t> curve{};  // with its place in it
    std::size_t member = 0;
  };
  // A curve, and the stop tests of its points.
  struct JointStopTests {
    std::vector<int> points;
    Curve along;
    CurveStopTests stop_tests;
  };
  const Point& point_at(int point) const { return points_[static_cast<std::size_t>(point)]; }
  Point& point_at(int point) { return points_[static_cast<std::size_t>(point)]; }
  // Returns the phase of the seed, for which it makes room. Throws std::out_of_range beyond the maximum.
  Phase& phase_of(SeedId id);
  static void close(Point& point);
  // Makes the stop tests of a point; `again` replaces those made.
  std::vector<Change> stop_test_at(int number, bool again);
  std::vector<Change> stop_test_at(JointStopTests& curve, bool again);
  Change take(int number, std::vector<StopTest> stop_tests);
  bool is_waiting(const Point& point) const {
    return point.curve && curves_[*point.curve].stop_tests.is_waiting(point.member);
  }
  static void count_in(Point& point, const Outcome& outcome);
  // Returns the number of seeds of the next stop test (steps = 0), or of the one `steps` after it; of a point
  // that waits, those of the one before.
  int stop_test_ahead(const Point& point, int steps) const;
  bool is_open(const Point& point) const;
  // Returns the mean over the points with a known cost; nothing if there are none.
  std::optional<double> seconds_per_work() const;
  // The urgency of a point; the largest goes first.
  struct Rank {
    int pass = 0;  // seeds that it lacks in the first pass
    double urgency = 0;
    auto operator<=>(const Rank&) const = default;
  };
  Rank rank(const Point& point, double seconds) const;
  double expected_fall(const Point& point) const;
  // Returns the number of waiting seeds of the next stop test.
  int waiting(const Point& point) const;
  // Returns the first waiting seed of the next stop test, or of the one `steps` after it.
  std::optional<int> waiting_seed(int number, int steps, const Allows& allows) const;
  // The seeds from Point::closed to a stop test: the known phases, and the number of seeds beyond them.
  struct Stretch {
    std::span<const Phase> known;
    int beyond = 0;
  };
  Stretch still_open(const Point& point, int steps) const;
  std::optional<SeedId> most_urgent(int steps, double budget, const Allows& allows) const;

  Target target_;
  int minimum_, maximum_, ceiling_;
  std::vector<int> schedule_;
  Allocation allocation_ = Allocation::longest_first;
  std::vector<Point> points_;
  std::vector<JointStopTests> curves_;
};

// The report of a run under a budget of processor time.

// The sum of the relative half-widths of the last stop tests, over the points that are not cancelled. A point
// without a stop test or interval counts as 1. There are no points if the tolerance is absolute.
struct SummedError {
  double sum = 0;
  int points = 0, unknown = 0;
};
SummedError summed_error(const Scheduler& scheduler);

// Returns "budget: 1.98 of 2 h of processor time spent; ...", with the sums after and before the run.
std::string budget_text(double spent_seconds, double budget_seconds, const SummedError& before,
                        const SummedError& after);

}  // namespace peclet::runner
