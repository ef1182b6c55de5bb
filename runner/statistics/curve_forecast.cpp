#include "runner/statistics/curve_forecast.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <set>

#include "runner/statistics/curve_fit.h"

namespace peclet::runner {

// The points of a curve as one criterion sees them, apart from the others of the target.
class CurveForecast::OneCriterion {
 public:
  OneCriterion(const Curve& curve, const std::vector<SeedsSoFar>& points, const Criterion& criterion,
               const Target& target, int minimum, int maximum)
      : alone_{criterion.observable, criterion.tolerance, target.confidence},
        rule_(alone_, minimum, maximum) {
    const std::vector<std::string> all = target.observables();
    const std::vector<std::string> own = alone_.observables();
    for (const std::size_t number : curve.points) {
      const SeedsSoFar& point = points[number];
      Member member{{}, point.ended, 1, point.cost, point.is_done};
      for (const std::string& name : own) {
        const auto place = std::ranges::find(all, name) - all.begin();
        member.estimates.push_back(point.estimates.at(static_cast<std::size_t>(place)));
      }
      members_.push_back(std::move(member));
    }
    if (alone_.tolerance.is_of_curve()) fit(curve.axis);
  }

  // Returns the seeds at which each point is expected to meet the criterion.
  std::vector<int> stops(const TruthOf& truth_of) const {
    StopRule rule = rule_;
    std::vector<Member> members = members_;
    for (Member& member : members) {
      member.alone = rule.schedule().front();
      const Estimate& own = member.estimates.front();
      if (own.count < 2 || !rule.has_measure(member.estimates)) continue;
      const Truth truth = truth_of ? truth_of(own.count) : Truth{};
      member.variance = truth.variance;
      if (member.seeds < member.alone || !rule.is_met(member.estimates))
        member.alone = stop_after(member.estimates, member.seeds, rule, truth);
    }
    make_rounds(members);
    std::vector<char> is_on_curve(members.size(), 0);
    for (const std::size_t i : on_curve_) is_on_curve[i] = 1;
    std::vector<int> stops;
    for (std::size_t i = 0; i < members.size(); ++i)
      stops.push_back(is_on_curve[i] == 1 || members[i].is_done ? members[i].seeds : members[i].alone);
    return stops;
  }

 private:
  struct Member {
    std::vector<Estimate> estimates;  // its own first
    int seeds = 0;                    // ended, then expected
    double variance = 1;              // true variance over that of the sample
    double cost = 0;
    bool is_done = false;
    int alone = 0;  // seeds at which its own interval meets the criterion
  };

  int next_seeds(const Member& member) const {
    return *std::upper_bound(rule_.schedule().begin(), rule_.schedule().end() - 1, member.seeds);
  }
  // Returns the variance of the logarithm of the mean of further seeds.
  static double noise_of(const Member& member, int more) {
    const Estimate& known = member.estimates.front();
    return std::pow(known.standard_error / known.mean, 2) * known.count * member.variance / more;
  }

  void fit(const std::vector<double>& axis) {
    std::vector<CurveFit::Datum> data;
    std::vector<std::size_t> known;
    for (std::size_t i = 0; i < members_.size(); ++i) {
      const Estimate& own = members_[i].estimates.front();
      if (!CurveFit::takes(own)) continue;
      data.push_back({axis[i], own.mean, own.standard_error, own.count});
      known.push_back(i);
    }
    const std::optional<CurveFit::Through> through = CurveFit::through(data, alone_.tolerance.is_even);
    if (!through || through->fit.is_refused()) return;
    std::vector<double> axes;
    for (const std::size_t datum : through->data) {
      on_curve_.push_back(known[datum]);
      axes.push_back(data[datum].axis);
    }
    outlook_ = through->fit.outlook(axes);
  }

  void make_rounds(std::vector<Member>& members) const {
    CurveFit::Outlook outlook = outlook_;
    const auto take = [&](std::size_t place, int seeds) {
      Member& member = members[on_curve_[place]];
      if (seeds <= member.seeds) return;
      outlook.take(place, noise_of(member, seeds - member.seeds));
      member.seeds = seeds;
    };
    for (std::size_t place = 0; place < on_curve_.size(); ++place) {
      if (!members[on_curve_[place]].is_done) take(place, rule_.schedule().front());
    }
    while (true) {
      const std::set<std::size_t> next = next_of(members, outlook);
      if (next.empty()) return;
      for (const std::size_t place : next) take(place, next_seeds(members[on_curve_[place]]));
    }
  }

  // Returns the places that make their next stop test in this round.
  std::set<std::size_t> next_of(const std::vector<Member>& members, const CurveFit::Outlook& outlook) const {
    const bool has_costs = std::ranges::all_of(on_curve_, [&](std::size_t i) { return members[i].cost > 0; });
    std::vector<std::optional<CurveFit::Outlook::Offer>> offers;
    for (const std::size_t i : on_curve_) {
      const Member& member = members[i];
      const int more = next_seeds(member) - member.seeds;
      offers.emplace_back();
      if (more > 0 && !member.is_done)
        offers.back() = {noise_of(member, more), more * (has_costs ? member.cost : 1)};
    }
    const double normal = boost::math::quantile(boost::math::normal(), (1 + rule_.confidence()) / 2);
    const std::vector<CurveFit::Value> values = outlook.values();
    const std::vector<std::size_t> best = outlook.best(offers);
    std::set<std::size_t> next;
    for (std::size_t place = 0; place < on_curve_.size(); ++place) {
      const Member& member = members[on_curve_[place]];
      const bool is_met = member.seeds >= member.alone ||
                          std::expm1(normal * values[place].deviation) <= alone_.tolerance.value;
      if (!is_met && offers[place]) next.insert(best[place]);
    }
    return next;
  }

  Target alone_;
  StopRule rule_;
  std::vector<Member> members_;
  std::vector<std::size_t> on_curve_;  // the member at each place of the outlook; none without a curve
  CurveFit::Outlook outlook_;
};

CurveForecast::CurveForecast(const Curve& curve, const std::vector<SeedsSoFar>& points, const Target& target,
                             int minimum, int maximum) {
  for (const Criterion& criterion : target.criteria())
    criteria_.emplace_back(curve, points, criterion, target, minimum, maximum);
}

CurveForecast::CurveForecast(CurveForecast&&) noexcept = default;
CurveForecast::~CurveForecast() = default;

std::vector<int> CurveForecast::stops(const TruthOf& truth_of) const {
  std::vector<int> most;
  for (const OneCriterion& criterion : criteria_) {
    const std::vector<int> stops = criterion.stops(truth_of);
    most.resize(stops.size());
    std::ranges::transform(most, stops, most.begin(),
                           [](int one, int other) { return std::max(one, other); });
  }
  return most;
}

}  // namespace peclet::runner
