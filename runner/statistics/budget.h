// What a run under a budget of processor time has bought.
#pragma once

#include <string>

#include "runner/statistics/scheduler.h"

namespace peclet::runner {

// Relative half-widths of the last looks, summed over the points that are not cancelled; of no point where
// the tolerance is absolute. One that has no look, or none with an interval, counts as 1: its mean is not
// known at all.
struct SummedError {
  double sum = 0;
  int points = 0, unknown = 0;
};
SummedError summed_error(const Scheduler& scheduler);

// "budget: 1.98 of 2 h of processor time spent; the relative half-widths of 6 points sum to 0.31, before to
// 2.4 (2 points without a look count as 1)"
std::string budget_text(double spent_seconds, double budget_seconds, const SummedError& before,
                        const SummedError& after);

}  // namespace peclet::runner
