#include "runner/cohorts.h"

#include <algorithm>
#include <cmath>

namespace peclet::runner {
namespace {

bool is_closed(const std::vector<std::optional<Outcome>>& outcomes, int seeds) {
  const auto count = static_cast<std::ptrdiff_t>(seeds);
  return std::ssize(outcomes) >= count &&
         std::all_of(outcomes.begin(), outcomes.begin() + count,
                     [](const std::optional<Outcome>& outcome) { return outcome.has_value(); });
}

// Not within it either: an interval that does not exist, and one around a mean of 0.
bool is_within_tolerance(const Look& look, const Target& target) {
  return relative_width(look) <= target.relative_tolerance;
}

Verdict judge(const Look& look, const Target& target, int minimum, int maximum) {
  if (is_within_tolerance(look, target)) {
    return look.lost == 0 ? Verdict::converged : Verdict::converged_with_losses;
  }
  // Where not one of the first seeds lives, more of them are waste.
  const bool none_lives = look.seeds == minimum && look.estimate.count == 0;
  if (none_lives) return Verdict::failed;
  if (look.seeds < maximum) return Verdict::more;
  return look.estimate.count < 2 ? Verdict::failed : Verdict::capped;
}

Look look_at(std::span<const std::optional<Outcome>> cohort, const Target& target) {
  std::vector<double> values, controlled;
  for (const std::optional<Outcome>& outcome : cohort) {
    if (outcome->kind == Outcome::Kind::lost) continue;
    values.push_back(outcome->value);
    controlled.push_back(outcome->value + outcome->control);
  }
  Look look;
  look.seeds = static_cast<int>(cohort.size());
  look.lost = look.seeds - static_cast<int>(values.size());
  look.estimate = estimate(values);
  look.half_width = student_half_width(look.estimate, target.confidence);
  look.controlled = estimate(controlled);
  look.controlled_half_width = student_half_width(look.controlled, target.confidence);
  return look;
}

}  // namespace

double relative_width(const Look& look) {
  return look.controlled_half_width / std::abs(look.controlled.mean);
}

std::vector<int> look_schedule(int minimum, int maximum) {
  std::vector<int> schedule;
  // In whole numbers: ceil(1.25 n) = floor((5 n + 3) / 4).
  for (int seeds = minimum; seeds < maximum; seeds = (5 * seeds + 3) / 4) schedule.push_back(seeds);
  schedule.push_back(maximum);
  return schedule;
}

std::vector<Look> replay_looks(const std::vector<std::optional<Outcome>>& outcomes, const Target& target,
                               int minimum, int maximum) {
  std::vector<Look> looks;
  for (const int seeds : look_schedule(minimum, maximum)) {
    if (!is_closed(outcomes, seeds)) break;
    looks.push_back(look_at(std::span(outcomes).first(static_cast<std::size_t>(seeds)), target));
    looks.back().verdict = judge(looks.back(), target, minimum, maximum);
    if (looks.back().verdict != Verdict::more) break;
  }
  return looks;
}

}  // namespace peclet::runner
