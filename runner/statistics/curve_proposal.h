// Proposes the seeds that lower the largest error of a curve most for their cost: at new places of the axis,
// or at points that are there.
//
// The curve is looked at on its points and three places between neighbours. One step after the other, the
// largest half-width of the band is found, and that place or point is taken which lowers the variance there
// most for its cost. A new point gets the seeds of a first stop test, an old one those of its next stop test.
// The mean is assumed to stay as it is. Spread and cost of a seed between points follow from those of the
// neighbours, by their logarithms. Of equal gains the smaller axis counts. The proposal depends on its
// numbers alone.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runner/campaign/campaign.h"
#include "runner/statistics/curve_fit.h"
#include "runner/statistics/scheduler.h"

namespace peclet::runner {

// A point of the curve as it stands.
struct KnownOnCurve {
  CurveFit::Datum datum;
  int seeds = 0;    // of its last stop test
  double cost = 0;  // of a seed, in any unit
};

struct CurveProposal {
  double axis = 0;
  bool is_new = false;
  int from = 0, to = 0;  // seeds before and after
  double cost = 0;       // of these
  double width = 0;      // largest relative half-width of the band afterwards
  double widest_at = 0;  // where that was before
};

struct ProposalBounds {
  double width = 0;              // ends where the largest relative half-width is not above it
  std::optional<double> cost{};  // of all proposals
  int new_points = 0;            // ends before the next one; 0: more seeds at old points only
  bool old_points = true;        // false: new points only
  int steps = 100;               // at most
};

struct CurvePlan {
  double width = 0;  // largest relative half-width of the band before
  double at = 0;     // where
  std::vector<CurveProposal> proposals{};
  double width_at_points = 0;  // largest relative half-width at points, old and new, afterwards
};

// Returns nothing if too few points make a curve (CurveFit::through). Requires positive costs. `schedule` has
// the seeds of the stop tests; `confidence` is the level of the band.
std::optional<CurvePlan> plan_curve(const std::vector<KnownOnCurve>& points, bool is_even,
                                    const std::vector<int>& schedule, double confidence,
                                    const ProposalBounds& bounds);

// A new value of the axis, for all curves of a campaign.
struct ChosenValue {
  double value = 0;
  std::string observable;  // of the band that asks for it
  double width = 0;        // largest relative half-width of that band
};

// Returns the next value that a campaign with `most_values` is to add: the new place of plan_curve(), with
// steps of an engine as its cost, for the widest band beside its tolerance. Nothing if a point is not
// decided, all bands are within their tolerances or refused, or the axis has that many values. A pure
// function of outcomes and cancelled points.
std::optional<ChosenValue> choose_value(const Scheduler& scheduler, const Campaign& campaign);

}  // namespace peclet::runner
