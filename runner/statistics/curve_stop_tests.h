// Makes the stop tests of all points of a curve together, in rounds.
//
// In the first round each point makes its first stop test. At the end of a round the curve is estimated from
// the last stop test of each point (curve_fit.h). A point is met if each criterion is within its tolerance,
// by the point's own interval or, for a criterion with a curve, by the band; a curve that a point contradicts
// decides nothing. If each point is met or at the maximum, all of them are decided. Otherwise some points
// make their next stop test in the next round: for each unmet point the one, itself or another, whose next
// stop test lowers the variance of the band there most per step and sphere of an engine. If the curve is
// refused or the criterion has none, it is the unmet point itself.
//
// The rounds depend on the outcomes alone, and on the points that are cancelled: these are not waited for. A
// curve of a single round, with a fixed number of seeds, is decided by it.
#pragma once

#include <optional>
#include <vector>

#include "runner/campaign/campaign.h"
#include "runner/statistics/cohorts.h"
#include "runner/statistics/curve_fit.h"

namespace peclet::runner {

class CurveStopTests {
 public:
  // A point of the curve with its outcomes, which must outlive the next call of advance().
  struct Member {
    const std::vector<std::optional<Outcome>>* outcomes = nullptr;
    bool cancelled = false;
  };

  CurveStopTests(Curve curve, Target target, int minimum, int maximum);

  // Makes all stop tests that the outcomes allow beyond those made. Returns the points with a stop test that
  // is new or has changed.
  std::vector<std::size_t> advance(const std::vector<Member>& members);

  // Returns the stop tests of a point. The last one decides unless its verdict is `more`.
  const std::vector<StopTest>& stop_tests(std::size_t member) const { return members_[member].stop_tests; }
  // Returns the mean steps of the realisations of a point's first stop test times its spheres; 0 if unknown.
  double work(std::size_t member) const { return members_[member].work; }
  // True if the point has made its stop test of this round, and others have not.
  bool is_waiting(std::size_t member) const { return !is_decided_ && !members_[member].is_next; }

 private:
  struct State {
    std::vector<StopTest> stop_tests{};
    Verdict own = Verdict::more;  // of the last stop test, by the point's own intervals
    bool is_next = true;          // makes its next stop test in this round
    double work = 0;              // as work()
  };
  // One criterion with a curve, at the end of a round.
  struct Round;

  bool is_at_maximum(const State& state) const { return state.stop_tests.size() == rule_.schedule().size(); }
  // Returns the places of the criteria with a curve among the observables, of which the criteria are the
  // first.
  std::vector<std::size_t> places_of_curves() const;
  void end_round(const std::vector<Member>& members);
  Round estimate(std::size_t place, const Tolerance& tolerance, const std::vector<Member>& members);
  // Returns what the next stop test of each member of a round would tell, and its work.
  std::vector<std::optional<CurveFit::Outlook::Offer>> offers(const Round& round,
                                                              const std::vector<Member>& members) const;
  int next_seeds(const State& state) const { return rule_.schedule()[state.stop_tests.size()]; }

  Curve curve_;
  Target target_;
  StopRule rule_;
  std::vector<State> members_;
  bool is_decided_ = false;
};

}  // namespace peclet::runner
