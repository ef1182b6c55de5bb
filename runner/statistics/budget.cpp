#include "runner/statistics/budget.h"

#include <fmt/format.h>

#include <cmath>

#include "runner/campaign/number_text.h"

namespace peclet::runner {
namespace {

std::string sum_text(const SummedError& error) {
  if (error.unknown == 0) return rough(error.sum);
  return fmt::format("{} ({} of them without an interval, each counted as 1)", rough(error.sum),
                     error.unknown);
}

}  // namespace

SummedError summed_error(const Scheduler& scheduler) {
  SummedError error;
  if (!scheduler.target().tolerance.is_relative()) return error;
  for (int point = 0; point < scheduler.points(); ++point) {
    if (scheduler.cancelled(point)) continue;
    ++error.points;
    const std::vector<Look>& looks = scheduler.looks(point);
    const double width = looks.empty() ? std::nan("") : relative_width(looks.back());
    error.sum += std::isfinite(width) ? width : 1;
    error.unknown += std::isfinite(width) ? 0 : 1;
  }
  return error;
}

std::string budget_text(double spent_seconds, double budget_seconds, const SummedError& before,
                        const SummedError& after) {
  const std::string spent =
      fmt::format("budget: {} of {} h of processor time spent", rough(spent_seconds / seconds_per_hour),
                  rough(budget_seconds / seconds_per_hour));
  if (after.points == 0) return spent + '\n';
  return fmt::format(
      "{}; relative half-widths of the {}{} last looks sum to "
      "{},\n        before to {}\n",
      spent, counted(static_cast<std::size_t>(after.points), "point"), after.points == 1 ? "'s" : "'",
      sum_text(after), sum_text(before));
}

}  // namespace peclet::runner
