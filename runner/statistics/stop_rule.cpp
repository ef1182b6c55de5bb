#include "runner/statistics/stop_rule.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace peclet::runner {
namespace {

// Probabilities of a larger spread: see the header.
constexpr double before_last = 0.02, at_last = 0.05;

// Looks of fewer values than the smallest minimum are of campaigns with a single look, or with many losses:
// their spread is all but unknown, and what it might be at most is no measure.
constexpr int fewest_degrees = 7;

constexpr std::array<std::pair<Verdict, const char*>, 6> verdict_names{
    {{Verdict::more, "more"},
     {Verdict::converged, "converged"},
     {Verdict::converged_with_losses, "converged-with-losses"},
     {Verdict::converged_near_maximum, "converged-near-maximum"},
     {Verdict::capped, "capped"},
     {Verdict::failed, "failed"}}};

double excess(int values, double probability) {
  return variance_excess(std::max(values - 1, fewest_degrees), probability);
}

}  // namespace

const char* to_string(Verdict verdict) {
  for (const auto& [known, name] : verdict_names) {
    if (known == verdict) return name;
  }
  return "?";
}

std::optional<Verdict> verdict_of(std::string_view word) {
  for (const auto& [known, name] : verdict_names) {
    if (name == word) return known;
  }
  return std::nullopt;
}

bool is_converged(Verdict verdict) {
  return verdict == Verdict::converged || verdict == Verdict::converged_with_losses;
}

double adjusted_confidence(double confidence, int minimum, int maximum) {
  return minimum == maximum ? confidence : 1 - (1 - confidence) * (1 - 1.4 / std::max(minimum, 2));
}

std::vector<int> look_schedule(int minimum, int maximum) {
  std::vector<int> schedule;
  // In whole numbers: ceil(1.25 n) = floor((5 n + 3) / 4).
  for (int seeds = minimum; seeds < maximum; seeds = (5 * seeds + 3) / 4) schedule.push_back(seeds);
  schedule.push_back(maximum);
  return schedule;
}

StopRule::StopRule(const Target& target, int minimum, int maximum)
    : target_(target),
      minimum_(minimum),
      maximum_(maximum),
      confidence_(adjusted_confidence(target.confidence, minimum, maximum)),
      schedule_(look_schedule(minimum, maximum)) {}

double StopRule::half_width(const Estimate& estimate) {
  if (estimate.count < 2) return std::nan("");
  const auto known = student_.find(estimate.count);
  const double factor =
      known != student_.end()
          ? known->second
          : student_.emplace(estimate.count, student_quantile(estimate.count - 1, confidence_)).first->second;
  return factor * estimate.standard_error;
}

double StopRule::needed(int seeds, int values, double width, Strictness strictness) {
  const auto key = std::pair(values, strictness);
  auto known = may_exceed_.find(key);
  if (known == may_exceed_.end()) {
    known = may_exceed_.emplace(key, excess(values, strictness == Strictness::last ? at_last : before_last))
                .first;
  }
  const double ratio = width * (1 + width) / target_.relative_tolerance;
  return seeds * ratio * ratio * known->second;
}

bool StopRule::converges(int seeds, int values, double width) {
  // Not so an interval that does not exist, and one around a mean of 0.
  if (values < 2 || !(width <= target_.relative_tolerance)) return false;
  if (target_.rule == Target::first_rule) return true;
  const Strictness strictness = seeds < maximum_ ? Strictness::before_last : Strictness::last;
  return needed(seeds, values, width, strictness) <= maximum_;
}

bool StopRule::stops(int seeds, int values, double width) {
  return seeds >= maximum_ || converges(seeds, values, width);
}

StopRule::Judgement StopRule::judge(int seeds, const Estimate& estimate) {
  const double own = half_width(estimate);
  const double width = own / std::abs(estimate.mean);
  if (converges(seeds, estimate.count, width)) {
    const Strictness strictness = seeds < maximum_ ? Strictness::before_last : Strictness::last;
    const bool is_near = target_.rule != Target::first_rule &&
                         needed(seeds, estimate.count, width, strictness) > maximum_ / 3.0;
    return {estimate.count == seeds ? Verdict::converged : Verdict::converged_with_losses,
            is_near ? std::max(own, target_.relative_tolerance * std::abs(estimate.mean)) : own};
  }
  // Where not one of the first seeds lives, more of them are waste.
  if (seeds == minimum_ && estimate.count == 0) return {Verdict::failed, own};
  if (seeds < maximum_) return {Verdict::more, own};
  if (estimate.count < 2) return {Verdict::failed, own};
  // Not so around a mean of 0, whose width has no end.
  const bool is_within = std::isfinite(width) && width <= target_.relative_tolerance * (1 + width);
  if (target_.rule == Target::first_rule || !is_within) return {Verdict::capped, own};
  return {Verdict::converged_near_maximum, widened(estimate, width)};
}

double StopRule::widened(const Estimate& estimate, double width) {
  const double factor = std::sqrt(excess(estimate.count, before_last));
  return std::max(target_.relative_tolerance, width * (1 + width) * factor) * std::abs(estimate.mean);
}

}  // namespace peclet::runner
