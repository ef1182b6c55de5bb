#include "runner/statistics/curve_stop_tests.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <utility>

namespace peclet::runner {
namespace {

// Returns the mean steps of the realisations with a value; 0 if one of them is unknown.
double mean_steps(const std::vector<std::optional<Outcome>>& outcomes, int seeds) {
  double steps = 0;
  int count = 0;
  for (int seed = 0; seed < seeds; ++seed) {
    const Outcome& outcome = *outcomes[static_cast<std::size_t>(seed)];
    if (outcome.is_lost()) continue;
    if (outcome.steps <= 0) return 0;
    steps += outcome.steps;
    ++count;
  }
  return count == 0 ? 0 : steps / count;
}

}  // namespace

// The curve of one criterion, through the members that have a logarithm.
struct CurveStopTests::Round {
  std::vector<std::size_t> member{};  // at each place of the outlook
  std::size_t observable = 0;
  // For each place the one whose next stop test lowers the variance there most for its work. Absent if too
  // few points are known, and if the curve is refused.
  std::optional<std::vector<std::size_t>> best{};

  // Returns the member whose next stop test is best for an unmet one.
  std::size_t best_for(std::size_t unmet) const {
    const auto place = std::ranges::find(member, unmet) - member.begin();
    return best && place < std::ssize(member) ? member[(*best)[static_cast<std::size_t>(place)]] : unmet;
  }
};

CurveStopTests::CurveStopTests(Curve curve, Target target, int minimum, int maximum)
    : curve_(std::move(curve)),
      target_(std::move(target)),
      rule_(target_, minimum, maximum),
      members_(curve_.axis.size()) {}

std::vector<std::size_t> CurveStopTests::advance(const std::vector<Member>& members) {
  std::vector<char> has_changed(members_.size(), 0);
  while (!is_decided_) {
    bool is_complete = true;
    for (std::size_t i = 0; i < members_.size(); ++i) {
      State& state = members_[i];
      if (!state.is_next) continue;
      std::optional<StopTest> made = stop_test_over(next_seeds(state), *members[i].outcomes, target_, rule_);
      if (!made) {
        is_complete = is_complete && members[i].cancelled;
        continue;
      }
      const double spheres = curve_.spheres.empty() ? 1 : curve_.spheres[i];
      if (state.stop_tests.empty()) state.work = mean_steps(*members[i].outcomes, made->seeds) * spheres;
      state.own = made->verdict;
      made->verdict = state.own == Verdict::failed ? Verdict::failed : Verdict::more;
      made->near_maximum = false;
      for (const std::size_t place : places_of_curves()) made->each[place].curve.emplace();
      state.stop_tests.push_back(*std::move(made));
      state.is_next = false;
      has_changed[i] = 1;
    }
    if (!is_complete) break;
    end_round(members);
    std::ranges::fill(has_changed, 1);
  }
  std::vector<std::size_t> changed;
  for (std::size_t i = 0; i < members_.size(); ++i) {
    if (has_changed[i] == 1) changed.push_back(i);
  }
  return changed;
}

std::vector<std::size_t> CurveStopTests::places_of_curves() const {
  std::vector<std::size_t> places;
  const std::vector<Criterion> criteria = target_.criteria();
  for (std::size_t place = 0; place < criteria.size(); ++place) {
    if (criteria[place].tolerance.is_of_curve()) places.push_back(place);
  }
  return places;
}

CurveStopTests::Round CurveStopTests::estimate(std::size_t place, const Tolerance& tolerance,
                                               const std::vector<Member>& members) {
  Round round;
  round.observable = place;
  std::vector<CurveFit::Datum> data;
  std::vector<std::size_t> known;  // the member of each datum
  for (std::size_t i = 0; i < members_.size(); ++i) {
    if (members_[i].stop_tests.empty()) continue;
    ObservableStopTest& one = members_[i].stop_tests.back().each[place];
    one.curve.emplace();
    if (!CurveFit::takes(one.estimate)) continue;
    known.push_back(i);
    data.push_back({curve_.axis[i], one.estimate.mean, one.estimate.standard_error, one.estimate.count});
  }
  std::optional<CurveFit::Through> through = CurveFit::through(data, tolerance.is_even);
  if (!through) return round;
  const CurveFit& fit = through->fit;
  std::vector<double> axes;
  for (const std::size_t datum : through->data) {
    axes.push_back(data[datum].axis);
    round.member.push_back(known[datum]);
  }
  const double normal = boost::math::quantile(boost::math::normal(), (1 + rule_.confidence()) / 2);
  const CurveFit::Outlook outlook = fit.outlook(axes);
  const std::vector<CurveFit::Value> values = outlook.values();
  for (std::size_t k = 0; k < round.member.size(); ++k) {
    const double half_width = normal * values[k].deviation;
    const auto [distance, allowed] = fit.residuals()[k];
    members_[round.member[k]].stop_tests.back().each[place].curve = {std::exp(values[k].mean),
                                                                     std::exp(values[k].mean - half_width),
                                                                     std::exp(values[k].mean + half_width),
                                                                     std::expm1(half_width) / tolerance.value,
                                                                     distance,
                                                                     allowed,
                                                                     fit.is_refused()};
  }
  if (!fit.is_refused()) round.best = outlook.best(offers(round, members));
  return round;
}

void CurveStopTests::end_round(const std::vector<Member>& members) {
  const std::vector<Criterion> criteria = target_.criteria();  // first among the observables, in this order
  std::vector<char> goes_on(members_.size(), 0);
  for (std::size_t place = 0; place < criteria.size(); ++place) {
    Round round;
    if (criteria[place].tolerance.is_of_curve()) round = estimate(place, criteria[place].tolerance, members);
    for (std::size_t i = 0; i < members_.size(); ++i) {
      const State& state = members_[i];
      if (state.stop_tests.empty() || members[i].cancelled || state.own == Verdict::failed ||
          is_at_maximum(state))
        continue;
      const ObservableStopTest& one = state.stop_tests.back().each[place];
      if (one.share <= 1 || (one.curve && one.curve->is_met())) continue;
      goes_on[round.best_for(i)] = 1;
    }
  }
  is_decided_ = std::ranges::count(goes_on, 1) == 0;
  for (std::size_t i = 0; i < members_.size(); ++i) {
    State& state = members_[i];
    state.is_next = goes_on[i] == 1;
    if (state.stop_tests.empty()) continue;
    StopTest& last = state.stop_tests.back();
    for (const std::size_t place : places_of_curves()) last.each[place].curve->goes_on = state.is_next;
    if (!is_decided_) continue;
    last.verdict = Verdict::converged;
    for (std::size_t place = 0; place < criteria.size(); ++place) {
      ObservableStopTest& one = last.each[place];
      if (one.curve && one.curve->is_met() && !is_reached(*one.verdict)) {
        one.verdict = one.estimate.count == last.seeds ? Verdict::converged : Verdict::converged_with_losses;
      }
      last.verdict = less_favourable(last.verdict, *one.verdict);
    }
    last.near_maximum = is_near_maximum(last, target_, rule_.schedule().back());
  }
}

std::vector<std::optional<CurveFit::Outlook::Offer>> CurveStopTests::offers(
    const Round& round, const std::vector<Member>& members) const {
  const bool is_known =
      std::ranges::all_of(round.member, [this](std::size_t i) { return members_[i].work > 0; });
  std::vector<std::optional<CurveFit::Outlook::Offer>> offers;
  for (const std::size_t i : round.member) {
    const State& state = members_[i];
    offers.emplace_back();
    if (is_at_maximum(state) || members[i].cancelled) continue;
    const StopTest& last = state.stop_tests.back();
    const Estimate& estimate = last.each[round.observable].estimate;
    const double error = estimate.standard_error / estimate.mean;
    const int more = next_seeds(state) - last.seeds;
    offers.back() = {error * error * estimate.count / more, more * (is_known ? state.work : 1)};
  }
  return offers;
}

}  // namespace peclet::runner
