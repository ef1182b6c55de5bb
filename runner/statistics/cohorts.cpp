#include "runner/statistics/cohorts.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <charconv>
#include <cmath>
#include <set>
#include <utility>

#include "runner/statistics/number_layout.h"
#include "runner/statistics/window_advice.h"

namespace peclet::runner {
namespace {

bool is_closed(const std::vector<std::optional<Outcome>>& outcomes, int seeds) {
  const auto count = static_cast<std::ptrdiff_t>(seeds);
  return std::ssize(outcomes) >= count &&
         std::all_of(outcomes.begin(), outcomes.begin() + count,
                     [](const std::optional<Outcome>& outcome) { return outcome.has_value(); });
}

// Returns the observations of one observable that have a value, in the order of the seeds.
std::vector<Observation> observed_in(std::span<const std::optional<Outcome>> cohort, std::size_t place) {
  std::vector<Observation> observed;
  observed.reserve(cohort.size());
  for (const std::optional<Outcome>& outcome : cohort) {
    const Observation observation = outcome->of(place);
    if (observation.has_value()) observed.push_back(observation);
  }
  return observed;
}

Estimate estimate_of(const std::vector<Observation>& observed, const std::vector<double>& values) {
  const bool are_shares = std::all_of(observed.begin(), observed.end(),
                                      [](const Observation& observation) { return observation.is_share; });
  return estimate(values, are_shares);
}

// Returns the stop test of an observable without half-width, share and verdict, which the stop rule gives.
ObservableStopTest stop_test_at(const std::vector<Observation>& observed) {
  std::vector<double> controlled;
  controlled.reserve(observed.size());
  int contrasts = 0;
  for (const Observation& observation : observed) {
    controlled.push_back(observation.controlled());
    if (std::isfinite(observation.first_half)) ++contrasts;
  }
  ObservableStopTest stop_test;
  stop_test.estimate = estimate_of(observed, controlled);
  stop_test.skewness = skewness(controlled);
  stop_test.transient = has_transient(observed);
  stop_test.untested = lacks_blocks(stop_test.estimate.count, contrasts);
  return stop_test;
}

Estimate without_control(const std::vector<Observation>& observed) {
  std::vector<double> values;
  values.reserve(observed.size());
  for (const Observation& observation : observed) values.push_back(observation.value);
  return estimate_of(observed, values);
}

StopTest stop_test_at(std::span<const std::optional<Outcome>> cohort, StopRule& rule,
                      const std::vector<std::string>& observables, const Target& target) {
  std::vector<ObservableStopTest> each;
  std::vector<Estimate> estimates;
  StopTest stop_test;
  stop_test.seeds = static_cast<int>(cohort.size());
  for (std::size_t place = 0; place < observables.size(); ++place) {
    const std::vector<Observation> observed = observed_in(cohort, place);
    if (place == 0) stop_test.estimate = without_control(observed);
    each.push_back(stop_test_at(observed));
    each.back().observable = observables[place];
  }
  stop_test.repeated = repeated_seeds(cohort);
  if (!stop_test.repeated.empty()) {
    stop_test.estimate.values = Estimate::Values::repeated;
    for (ObservableStopTest& one : each) one.estimate.values = Estimate::Values::repeated;
  }
  estimates.reserve(each.size());
  for (const ObservableStopTest& one : each) estimates.push_back(one.estimate);
  const StopRule::Judgement judgement = rule.judge(stop_test.seeds, estimates);
  for (std::size_t place = 0; place < each.size(); ++place) {
    const StopRule::Finding& finding = judgement.findings[place];
    each[place].half_width = finding.half_width;
    each[place].share = finding.share;
    each[place].verdict = finding.verdict;
    stop_test.transient = stop_test.transient || each[place].transient;
    stop_test.untested = stop_test.untested || each[place].untested;
  }
  stop_test.lost = stop_test.seeds - stop_test.estimate.count;
  stop_test.half_width = rule.half_width(stop_test.estimate);
  stop_test.controlled = each.front().estimate;
  stop_test.controlled_half_width = each.front().half_width;
  stop_test.skewness = each.front().skewness;
  stop_test.verdict = judgement.verdict;
  if (each.size() > 1 || !target.over().empty()) stop_test.each = std::move(each);
  stop_test.near_maximum = is_near_maximum(stop_test, target, rule.schedule().back());
  return stop_test;
}

}  // namespace

Outcome outcome_of(const NumberLayout& layout, std::span<const double> numbers,
                   const std::string& final_state_sha256) {
  constexpr std::size_t digits = 16;
  Outcome outcome{layout.observation(0, numbers)};
  if (outcome.is_lost()) return outcome;
  for (std::size_t place = 1; place < layout.observables().size(); ++place)
    outcome.further.push_back(layout.observation(place, numbers));
  std::from_chars(final_state_sha256.data(),
                  final_state_sha256.data() + std::min(digits, final_state_sha256.size()),
                  outcome.final_state, 16);
  return outcome;
}

void add(RunningEstimate& known, const Observation& observation) {
  if (observation.has_value()) known.add(observation.controlled(), observation.is_share);
}

std::vector<Estimate> estimates_so_far(std::span<const std::optional<Outcome>> outcomes,
                                       std::size_t observables) {
  std::vector<RunningEstimate> sums(observables);
  for (const std::optional<Outcome>& outcome : outcomes) {
    if (!outcome) continue;
    for (std::size_t place = 0; place < observables; ++place) add(sums[place], outcome->of(place));
  }
  return estimates_of(sums);
}

Observation Outcome::of(std::size_t place) const {
  if (is_lost()) return {};
  if (place == 0) return *this;
  return place <= further.size() ? further[place - 1] : Observation{};
}

std::vector<ObservableStopTest> each_of(const StopTest& stop_test, const Target& target) {
  if (!stop_test.each.empty()) return stop_test.each;
  return {{target.observable, stop_test.controlled, stop_test.controlled_half_width,
           target.tolerance.share(stop_test.controlled_half_width, stop_test.controlled.mean),
           stop_test.skewness, stop_test.transient, stop_test.untested, stop_test.verdict}};
}

double largest_share(const StopTest& stop_test, const Target& target) {
  double largest = 0;
  for (const ObservableStopTest& one : each_of(stop_test, target)) {
    if (!one.verdict) continue;
    const double share = one.smaller_share();
    if (std::isnan(share)) return share;
    largest = std::max(largest, share);
  }
  return largest;
}

std::vector<Estimate> estimates_of(const StopTest& stop_test, const Target& target) {
  std::vector<Estimate> estimates;
  for (const ObservableStopTest& one : each_of(stop_test, target)) estimates.push_back(one.estimate);
  return estimates;
}

bool is_near_maximum(const StopTest& stop_test, const Target& target, int maximum) {
  if (!is_reached(stop_test.verdict)) return false;
  const std::vector<ObservableStopTest> each = each_of(stop_test, target);
  return std::any_of(each.begin(), each.end(), [&](const ObservableStopTest& one) {
    return one.verdict && !one.is_decided_by_curve() &&
           is_near_maximum(stop_test.seeds, one.estimate.count, one.share, maximum);
  });
}

std::vector<std::string> without_interval(const StopTest& stop_test, const Target& target) {
  std::vector<std::string> found;
  for (const ObservableStopTest& one : each_of(stop_test, target)) {
    if (one.verdict && one.estimate.count > 1 && !std::isfinite(one.half_width))
      found.push_back(one.observable);
  }
  return found;
}

std::vector<int> repeated_seeds(std::span<const std::optional<Outcome>> cohort) {
  std::vector<int> repeated;
  std::set<std::uint64_t> seen;
  for (std::size_t seed = 0; seed < cohort.size(); ++seed) {
    const std::optional<Outcome>& outcome = cohort[seed];
    if (!outcome || outcome->is_lost() || outcome->final_state == 0) continue;
    if (!seen.insert(outcome->final_state).second) repeated.push_back(static_cast<int>(seed));
  }
  return repeated;
}

double relative_width(const StopTest& stop_test) {
  return stop_test.controlled_half_width / std::abs(stop_test.controlled.mean);
}

bool is_skewed(const StopTest& stop_test, double confidence) {
  const double n = stop_test.controlled.count;
  if (!std::isfinite(stop_test.skewness) || stop_test.controlled.values == Estimate::Values::share)
    return false;
  const double chance = std::sqrt(6 * n * (n - 1) / ((n - 2) * (n + 1) * (n + 3)));  // for normal values
  const boost::math::normal standard;
  const double z = boost::math::quantile(standard, (1 + confidence) / 2);
  const double loss = 2 * boost::math::pdf(standard, z) * z * (std::pow(z, 4) + 2 * z * z - 3) *
                      stop_test.skewness * stop_test.skewness / (18 * n);
  return std::abs(stop_test.skewness) > 2.5 * chance && loss > 0.01;
}

bool is_decided_by_curve(const StopTest& stop_test) {
  return std::ranges::any_of(stop_test.each, &ObservableStopTest::is_decided_by_curve);
}

bool waits_for_curve(const StopTest& stop_test) {
  bool has_curve = false;
  for (const ObservableStopTest& one : stop_test.each) {
    if (one.curve && one.curve->goes_on) return false;
    has_curve = has_curve || one.curve;
  }
  return has_curve && stop_test.verdict == Verdict::more;
}

bool has_control(const StopTest& stop_test) {
  return stop_test.estimate.count > 0 && stop_test.controlled.mean != stop_test.estimate.mean;
}

std::optional<StopTest> stop_test_over(int seeds, const std::vector<std::optional<Outcome>>& outcomes,
                                       const Target& target, StopRule& rule) {
  if (!is_closed(outcomes, seeds)) return std::nullopt;
  return stop_test_at(std::span(outcomes).first(static_cast<std::size_t>(seeds)), rule, target.observables(),
                      target);
}

std::vector<StopTest> replay_stop_tests(const std::vector<std::optional<Outcome>>& outcomes,
                                        const Target& target, int minimum, int maximum) {
  StopRule rule(target, minimum, maximum);
  std::vector<StopTest> stop_tests;
  for (const int seeds : rule.schedule()) {
    std::optional<StopTest> next = stop_test_over(seeds, outcomes, target, rule);
    if (!next) break;
    stop_tests.push_back(*std::move(next));
    if (stop_tests.back().verdict != Verdict::more) break;
  }
  return stop_tests;
}

Json number_json(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json estimate_json(const Estimate& estimate) {
  return {{"count", estimate.count},
          {"mean", number_json(estimate.mean)},
          {"standard_error", number_json(estimate.standard_error)}};
}

Estimate::Values stored_values(const Estimate& estimate, double half_width) {
  if (estimate.count < 2) return Estimate::Values::spread;
  if (std::isnan(half_width)) return Estimate::Values::equal;
  const double mean = estimate.mean, ones = estimate.count * mean;
  const double variance = estimate.standard_error * estimate.standard_error * (estimate.count - 1);
  // Both variances may be small, so they are compared relative to each other.
  constexpr double rounding = 1e-12, same = 1e-9;
  const bool is_share = half_width > 0 && mean >= 0 && mean <= 1 &&
                        std::abs(ones - std::round(ones)) <= rounding * estimate.count &&
                        std::abs(variance - mean * (1 - mean)) <= same * mean * (1 - mean);
  return is_share ? Estimate::Values::share : Estimate::Values::spread;
}

Json curve_json(const CurveBand& curve) {
  return {{"mean", number_json(curve.mean)},
          {"low", number_json(curve.low)},
          {"high", number_json(curve.high)},
          {"share_of_tolerance", number_json(curve.share)},
          {"residual", number_json(curve.residual)},
          {"allowed_residual", number_json(curve.allowed)},
          {"refused", curve.refused},
          {"goes_on", curve.goes_on}};
}

Json observables_json(const StopTest& stop_test) {
  Json json = Json::array();
  for (const ObservableStopTest& one : stop_test.each) {
    Json& of = json.emplace_back(estimate_json(one.estimate));
    of["observable"] = one.observable;
    of["half_width"] = number_json(one.half_width);
    of["share_of_tolerance"] = number_json(one.share);
    of["skewness"] = number_json(one.skewness);
    of["transient"] = one.untested ? Json(nullptr) : Json(one.transient);
    of["verdict"] = one.verdict ? Json(to_string(*one.verdict)) : Json(nullptr);
    if (one.curve) of["curve"] = curve_json(*one.curve);
  }
  return json;
}

std::vector<ObservableStopTest> observables_of(const Json& json) {
  const auto number = [](const Json& value) { return value.is_null() ? std::nan("") : value.get<double>(); };
  std::vector<ObservableStopTest> each;
  for (const Json& of : json) {
    ObservableStopTest& one = each.emplace_back();
    one.observable = of.at("observable").get<std::string>();
    one.estimate = {of.at("count").get<int>(), number(of.at("mean")), number(of.at("standard_error"))};
    one.half_width = number(of.at("half_width"));
    one.estimate.values = stored_values(one.estimate, one.half_width);
    one.share = number(of.at("share_of_tolerance"));
    one.skewness = number(of.at("skewness"));
    one.untested = of.at("transient").is_null();
    one.transient = !one.untested && of.at("transient").get<bool>();
    if (!of.at("verdict").is_null()) one.verdict = verdict_of(of.at("verdict").get<std::string>()).value();
    if (of.contains("curve")) {
      const Json& curve = of["curve"];
      one.curve = {number(curve.at("mean")),        number(curve.at("low")),
                   number(curve.at("high")),        number(curve.at("share_of_tolerance")),
                   number(curve.at("residual")),    number(curve.at("allowed_residual")),
                   curve.at("refused").get<bool>(), curve.at("goes_on").get<bool>()};
    }
  }
  return each;
}

Json stop_test_json(const StopTest& stop_test) {
  Json json = estimate_json(stop_test.controlled);
  json["seeds"] = stop_test.seeds;
  json["lost"] = stop_test.lost;
  json["half_width"] = number_json(stop_test.controlled_half_width);
  json["plain"] = estimate_json(stop_test.estimate);
  json["plain"]["half_width"] = number_json(stop_test.half_width);
  json["skewness"] = number_json(stop_test.skewness);
  json["transient"] = stop_test.untested ? Json(nullptr) : Json(stop_test.transient);
  json["verdict"] = to_string(stop_test.verdict);
  json["near_maximum"] = stop_test.near_maximum;
  json["repeated_seeds"] = stop_test.repeated;
  if (!stop_test.each.empty()) json["observables"] = observables_json(stop_test);
  return json;
}

}  // namespace peclet::runner
