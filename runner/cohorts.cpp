#include "runner/cohorts.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

#include "runner/transient.h"

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

Look look_at(std::span<const std::optional<Outcome>> cohort, double confidence) {
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
  look.half_width = student_half_width(look.estimate, confidence);
  look.controlled = estimate(controlled);
  look.controlled_half_width = student_half_width(look.controlled, confidence);
  look.skewness = skewness(controlled);
  look.transient = has_transient(cohort);
  return look;
}

}  // namespace

double relative_width(const Look& look) {
  return look.controlled_half_width / std::abs(look.controlled.mean);
}

double adjusted_confidence(double confidence, int minimum, int maximum) {
  return minimum == maximum ? confidence : 1 - (1 - confidence) * (1 - 1.4 / std::max(minimum, 2));
}

bool is_skewed(const Look& look, double confidence) {
  const double n = look.controlled.count;
  if (!std::isfinite(look.skewness)) return false;
  const double chance = std::sqrt(6 * n * (n - 1) / ((n - 2) * (n + 1) * (n + 3)));  // of a normal population
  const boost::math::normal standard;
  const double z = boost::math::quantile(standard, (1 + confidence) / 2);
  const double loss = 2 * boost::math::pdf(standard, z) * z * (std::pow(z, 4) + 2 * z * z - 3) *
                      look.skewness * look.skewness / (18 * n);
  return std::abs(look.skewness) > 2.5 * chance && loss > 0.01;
}

bool has_control(const Look& look) {
  return look.estimate.count > 0 && look.controlled.mean != look.estimate.mean;
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
  const double confidence = adjusted_confidence(target.confidence, minimum, maximum);
  std::vector<Look> looks;
  for (const int seeds : look_schedule(minimum, maximum)) {
    if (!is_closed(outcomes, seeds)) break;
    looks.push_back(look_at(std::span(outcomes).first(static_cast<std::size_t>(seeds)), confidence));
    looks.back().verdict = judge(looks.back(), target, minimum, maximum);
    if (looks.back().verdict != Verdict::more) break;
  }
  return looks;
}

}  // namespace peclet::runner
