#include "runner/statistics/stop_rule.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace peclet::runner {
namespace {

constexpr std::array verdict_names{"more",   "converged", "converged-with-losses", "capped",
                                   "failed", "complete",  "complete-with-losses"};  // in the order of Verdict

}  // namespace

const char* to_string(Verdict verdict) { return verdict_names.at(static_cast<std::size_t>(verdict)); }

std::optional<Verdict> verdict_of(std::string_view word) {
  const auto known = std::ranges::find(verdict_names, word);
  return known == verdict_names.end() ? std::nullopt
                                      : std::optional(static_cast<Verdict>(known - verdict_names.begin()));
}

bool is_reached(Verdict verdict) {
  return verdict == Verdict::converged || verdict == Verdict::complete || has_losses(verdict);
}

bool has_losses(Verdict verdict) {
  return verdict == Verdict::converged_with_losses || verdict == Verdict::complete_with_losses;
}

Verdict less_favourable(Verdict one, Verdict other) {
  constexpr std::array order{Verdict::converged,
                             Verdict::complete,
                             Verdict::converged_with_losses,
                             Verdict::complete_with_losses,
                             Verdict::capped,
                             Verdict::more,
                             Verdict::failed};
  const auto rank = [&](Verdict verdict) { return std::find(order.begin(), order.end(), verdict); };
  return std::max(rank(one), rank(other)) == rank(one) ? one : other;
}

double adjusted_confidence(double confidence, int minimum, int maximum) {
  return minimum == maximum ? confidence : 1 - (1 - confidence) * (1 - 1.4 / std::max(minimum, 2));
}

std::vector<int> stop_test_schedule(int minimum, int maximum) {
  std::vector<int> schedule;
  // For integers ceil(1.25 n) = floor((5 n + 3) / 4).
  for (int seeds = minimum; seeds < maximum; seeds = (5 * seeds + 3) / 4) schedule.push_back(seeds);
  schedule.push_back(maximum);
  return schedule;
}

StopRule::StopRule(const Target& target, int minimum, int maximum)
    : minimum_(minimum),
      maximum_(maximum),
      has_tolerance_(target.has_tolerance()),
      confidence_(adjusted_confidence(target.confidence, minimum, maximum)),
      schedule_(stop_test_schedule(minimum, maximum)) {
  const std::vector<std::string> observables = target.observables();
  observables_ = observables.size();
  const auto place_of = [&](const std::string& name) {
    return static_cast<std::size_t>(std::find(observables.begin(), observables.end(), name) -
                                    observables.begin());
  };
  for (const auto& [observable, tolerance] : target.criteria()) {
    const std::string& measure = tolerance.relative_to.empty() ? observable : tolerance.relative_to;
    parts_.push_back({tolerance, place_of(observable), place_of(measure)});
  }
}

double StopRule::half_width(const Estimate& estimate) {
  if (estimate.values != Estimate::Values::spread || estimate.count < 2) {
    return runner::half_width(estimate, confidence_);
  }
  const auto known = student_.find(estimate.count);
  const double factor =
      known != student_.end()
          ? known->second
          : student_.emplace(estimate.count, student_quantile(estimate.count - 1, confidence_)).first->second;
  return factor * estimate.standard_error;
}

bool StopRule::has_measure(Estimates estimates) const {
  return std::all_of(parts_.begin(), parts_.end(), [&](const Part& part) {
    return part.tolerance.half_width(estimates[part.measure].mean) > 0;
  });
}

double StopRule::share(const Part& part, Estimates estimates) {
  const Estimate& measure = estimates[part.measure];
  double mean = measure.mean;
  if (part.measure != part.place && measure.values != Estimate::Values::equal) {
    mean = std::max(0.0, std::abs(mean) - half_width(measure));
  }
  return part.tolerance.share(half_width(estimates[part.place]), mean);
}

bool StopRule::is_met(Estimates estimates) {
  return std::all_of(parts_.begin(), parts_.end(),
                     [&](const Part& part) { return share(part, estimates) <= 1; });
}

StopRule::Judgement StopRule::judge(int seeds, Estimates estimates) {
  Judgement judgement{Verdict::converged, std::vector<Finding>(observables_)};
  for (std::size_t place = 0; place < observables_; ++place) {
    judgement.findings[place].half_width = half_width(estimates[place]);
  }
  for (const Part& part : parts_) {
    Finding& finding = judgement.findings[part.place];
    finding.share = share(part, estimates);
    finding.verdict = verdict(seeds, estimates[part.place], finding.share);
    judgement.verdict = less_favourable(judgement.verdict, *finding.verdict);
  }
  return judgement;
}

Verdict StopRule::verdict(int seeds, const Estimate& estimate, double share) const {
  // False, too, if there is no interval or the mean is 0: the share is then NaN or infinite.
  if (share <= 1) return estimate.count == seeds ? Verdict::converged : Verdict::converged_with_losses;
  // If all seeds of the first cohort are lost, more seeds would be wasted.
  if (seeds == minimum_ && estimate.count == 0) return Verdict::failed;
  if (seeds < maximum_) return Verdict::more;
  if (!has_tolerance_) return estimate.count == seeds ? Verdict::complete : Verdict::complete_with_losses;
  return estimate.count < 2 ? Verdict::failed : Verdict::capped;
}

bool is_near_maximum(int seeds, int values, double share, int maximum) {
  constexpr double probability = 0.05;
  return values > 1 && seeds * share * share * variance_excess(values - 1, probability) > maximum;
}

}  // namespace peclet::runner
