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

Verdict less_favourable(Verdict one, Verdict other) {
  constexpr std::array order{Verdict::converged,
                             Verdict::converged_with_losses,
                             Verdict::converged_near_maximum,
                             Verdict::capped,
                             Verdict::more,
                             Verdict::failed};
  const auto rank = [&](Verdict verdict) { return std::find(order.begin(), order.end(), verdict); };
  return std::max(rank(one), rank(other)) == rank(one) ? one : other;
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

// An estimate as a criterion sees it.
struct StopRule::Measured {
  Estimate estimate;
  double own = 0;          // Student's half-width
  double good_enough = 0;  // the one that the tolerance allows
  double share = 0;        // of both
  double mean_factor = 1;  // 1 + w, for the mean of which a relative tolerance is a share
};

StopRule::StopRule(const Target& target, int minimum, int maximum)
    : rule_(target.rule),
      minimum_(minimum),
      maximum_(maximum),
      confidence_(adjusted_confidence(target.confidence, minimum, maximum)),
      schedule_(look_schedule(minimum, maximum)) {
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
  if (estimate.count < 2) return std::nan("");
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

StopRule::Measured StopRule::measure(const Part& part, Estimates estimates) {
  const Estimate& of = estimates[part.measure];
  Measured measured;
  measured.estimate = estimates[part.place];
  measured.own = half_width(measured.estimate);
  measured.good_enough = part.tolerance.half_width(of.mean);
  measured.share = part.tolerance.share(measured.own, of.mean);
  if (!part.tolerance.is_share_of(of.mean)) return measured;
  const bool is_own = part.measure == part.place;
  measured.mean_factor =
      1 + (is_own ? measured.share * part.tolerance.value : half_width(of) / std::abs(of.mean));
  return measured;
}

double StopRule::needed(int seeds, const Measured& measured, Strictness strictness) {
  const auto key = std::pair(measured.estimate.count, strictness);
  auto known = may_exceed_.find(key);
  if (known == may_exceed_.end()) {
    const double probability = strictness == Strictness::last ? at_last : before_last;
    known = may_exceed_.emplace(key, excess(measured.estimate.count, probability)).first;
  }
  const double ratio = measured.share * measured.mean_factor;
  return seeds * ratio * ratio * known->second;
}

bool StopRule::converges(int seeds, const Measured& measured) {
  // Not so an interval that does not exist, and a share of a mean of 0.
  if (measured.estimate.count < 2 || !(measured.share <= 1)) return false;
  if (rule_ == Target::first_rule) return true;
  const Strictness strictness = seeds < maximum_ ? Strictness::before_last : Strictness::last;
  return needed(seeds, measured, strictness) <= maximum_;
}

bool StopRule::stops(int seeds, Estimates estimates) {
  return seeds >= maximum_ || std::all_of(parts_.begin(), parts_.end(), [&](const Part& part) {
           return converges(seeds, measure(part, estimates));
         });
}

StopRule::Judgement StopRule::judge(int seeds, Estimates estimates) {
  Judgement judgement{Verdict::converged, std::vector<Finding>(observables_)};
  for (std::size_t place = 0; place < observables_; ++place) {
    judgement.findings[place] = {std::nullopt, half_width(estimates[place]), std::nan("")};
  }
  for (const Part& part : parts_) {
    Finding finding = judge(seeds, measure(part, estimates));
    finding.share = part.tolerance.share(finding.half_width, estimates[part.measure].mean);
    judgement.findings[part.place] = finding;
    judgement.verdict = less_favourable(judgement.verdict, *finding.verdict);
  }
  return judgement;
}

StopRule::Finding StopRule::judge(int seeds, const Measured& measured) {
  const auto& [estimate, own, good_enough, share, mean_factor] = measured;
  if (converges(seeds, measured)) {
    const Strictness strictness = seeds < maximum_ ? Strictness::before_last : Strictness::last;
    const bool is_near = rule_ != Target::first_rule && needed(seeds, measured, strictness) > maximum_ / 3.0;
    return {estimate.count == seeds ? Verdict::converged : Verdict::converged_with_losses,
            is_near ? std::max(own, good_enough) : own};
  }
  // Where not one of the first seeds lives, more of them are waste.
  if (seeds == minimum_ && estimate.count == 0) return {Verdict::failed, own};
  if (seeds < maximum_) return {Verdict::more, own};
  if (estimate.count < 2) return {Verdict::failed, own};
  // Not so around a mean of 0, whose relative width has no end.
  const bool is_within = std::isfinite(share) && share <= mean_factor;
  if (rule_ == Target::first_rule || !is_within) return {Verdict::capped, own};
  return {Verdict::converged_near_maximum, widened(measured)};
}

double StopRule::widened(const Measured& measured) const {
  const double factor = std::sqrt(excess(measured.estimate.count, before_last));
  return std::max(1.0, measured.share * measured.mean_factor * factor) * measured.good_enough;
}

}  // namespace peclet::runner
