#include "runner/statistics/cohorts.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

#include "runner/statistics/transient.h"

namespace peclet::runner {
namespace {

bool is_closed(const std::vector<std::optional<Outcome>>& outcomes, int seeds) {
  const auto count = static_cast<std::ptrdiff_t>(seeds);
  return std::ssize(outcomes) >= count &&
         std::all_of(outcomes.begin(), outcomes.begin() + count,
                     [](const std::optional<Outcome>& outcome) { return outcome.has_value(); });
}

Look look_at(std::span<const std::optional<Outcome>> cohort, StopRule& rule) {
  std::vector<double> values, controlled;
  int contrasts = 0;
  for (const std::optional<Outcome>& outcome : cohort) {
    if (outcome->kind == Outcome::Kind::lost) continue;
    values.push_back(outcome->value);
    controlled.push_back(outcome->value + outcome->control);
    if (std::isfinite(outcome->first_half)) ++contrasts;
  }
  Look look;
  look.seeds = static_cast<int>(cohort.size());
  look.lost = look.seeds - static_cast<int>(values.size());
  look.estimate = estimate(values);
  look.half_width = rule.half_width(look.estimate);
  look.controlled = estimate(controlled);
  const StopRule::Judgement judgement = rule.judge(look.seeds, look.controlled);
  look.controlled_half_width = judgement.half_width;
  look.verdict = judgement.verdict;
  look.skewness = skewness(controlled);
  look.transient = has_transient(cohort);
  look.untested = lacks_blocks(look.estimate.count, contrasts);
  return look;
}

}  // namespace

double relative_width(const Look& look) {
  return look.controlled_half_width / std::abs(look.controlled.mean);
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

std::vector<Look> replay_looks(const std::vector<std::optional<Outcome>>& outcomes, const Target& target,
                               int minimum, int maximum) {
  StopRule rule(target, minimum, maximum);
  std::vector<Look> looks;
  for (const int seeds : rule.schedule()) {
    if (!is_closed(outcomes, seeds)) break;
    looks.push_back(look_at(std::span(outcomes).first(static_cast<std::size_t>(seeds)), rule));
    if (looks.back().verdict != Verdict::more) break;
  }
  return looks;
}

}  // namespace peclet::runner
