#include "runner/statistics/curve_forecast.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <set>

#include "runner/statistics/curve_fit.h"

namespace peclet::runner {
namespace {

// The points of a curve as one criterion sees them, apart from the others of the target.
class CriterionForecast {
 public:
  CriterionForecast(const Criterion& criterion, const Target& target, int minimum, int maximum,
                    const TruthOf& truth_of)
      : alone_{criterion.observable, criterion.tolerance, target.confidence},
        rule_(alone_, minimum, maximum),
        truth_of_(truth_of) {
    const std::vector<std::string> all = target.observables();
    for (const std::string& name : alone_.observables())
      places_.push_back(static_cast<std::size_t>(std::ranges::find(all, name) - all.begin()));
  }

  void add(double axis, const SeedsSoFar& point) {
    std::vector<Estimate> estimates;
    for (const std::size_t place : places_) estimates.push_back(point.estimates.at(place));
    const Estimate& own = estimates.front();
    const bool is_known = own.count >= 2 && rule_.has_measure(estimates);
    const Truth truth = is_known && truth_of_ ? truth_of_(own.count) : Truth{};
    Member member{axis, own, point.ended, is_known ? truth.variance : 1, point.cost, point.is_done};
    member.alone = rule_.schedule().front();
    if (is_known && (point.ended < member.alone || !rule_.is_met(estimates)))
      member.alone = stop_after(estimates, point.ended, rule_, truth);
    members_.push_back(member);
  }

  // Returns the seeds at which each point is expected to meet the criterion.
  std::vector<int> seeds() {
    if (alone_.tolerance.is_of_curve()) make_rounds();
    std::vector<int> seeds;
    for (const Member& member : members_)
      seeds.push_back(member.is_on_curve || member.is_done ? member.seeds : member.alone);
    return seeds;
  }

 private:
  struct Member {
    double axis = 0;
    Estimate estimate;
    int seeds = 0;        // ended, then expected
    double variance = 1;  // true variance over that of the sample
    double cost = 0;
    bool is_done = false;
    int alone = 0;  // seeds at which its own interval meets the criterion
    bool is_on_curve = false;
  };

  int next_seeds(const Member& member) const {
    return *std::upper_bound(rule_.schedule().begin(), rule_.schedule().end() - 1, member.seeds);
  }
  // Returns the variance of the logarithm of the mean of further seeds.
  static double noise_of(const Member& member, int more) {
    const Estimate& known = member.estimate;
    return std::pow(known.standard_error / known.mean, 2) * known.count * member.variance / more;
  }

  void make_rounds() {
    std::vector<CurveFit::Datum> data;
    std::vector<Member*> known;
    for (Member& member : members_) {
      const Estimate& estimate = member.estimate;
      if (!CurveFit::takes(estimate)) continue;
      data.push_back({member.axis, estimate.mean, estimate.standard_error, estimate.count});
      known.push_back(&member);
    }
    const std::optional<CurveFit::Through> through = CurveFit::through(data, alone_.tolerance.is_even);
    if (!through || through->fit.is_refused()) return;
    std::vector<Member*> used;
    std::vector<double> axes;
    for (const std::size_t datum : through->data) {
      used.push_back(known[datum]);
      axes.push_back(known[datum]->axis);
      known[datum]->is_on_curve = true;
    }
    CurveFit::Outlook outlook = through->fit.outlook(axes);
    const auto take = [&](std::size_t place, int seeds) {
      Member& member = *used[place];
      if (seeds <= member.seeds) return;
      outlook.take(place, noise_of(member, seeds - member.seeds));
      member.seeds = seeds;
    };
    for (std::size_t place = 0; place < used.size(); ++place) {
      if (!used[place]->is_done) take(place, rule_.schedule().front());
    }
    while (true) {
      const std::set<std::size_t> next = next_of(used, outlook);
      if (next.empty()) return;
      for (const std::size_t place : next) take(place, next_seeds(*used[place]));
    }
  }

  // Returns the places that make their next stop test in this round.
  std::set<std::size_t> next_of(const std::vector<Member*>& used, const CurveFit::Outlook& outlook) const {
    const bool has_costs = std::ranges::all_of(used, [](const Member* member) { return member->cost > 0; });
    std::vector<std::optional<CurveFit::Outlook::Offer>> offers;
    for (const Member* const member : used) {
      const int more = next_seeds(*member) - member->seeds;
      offers.emplace_back();
      if (more > 0 && !member->is_done)
        offers.back() = {noise_of(*member, more), more * (has_costs ? member->cost : 1)};
    }
    const double normal = boost::math::quantile(boost::math::normal(), (1 + rule_.confidence()) / 2);
    const std::vector<CurveFit::Value> values = outlook.values();
    const std::vector<std::size_t> best = outlook.best(offers);
    std::set<std::size_t> next;
    for (std::size_t place = 0; place < used.size(); ++place) {
      const bool is_met = used[place]->seeds >= used[place]->alone ||
                          std::expm1(normal * values[place].deviation) <= alone_.tolerance.value;
      if (!is_met && offers[place]) next.insert(best[place]);
    }
    return next;
  }

  Target alone_;
  StopRule rule_;
  const TruthOf& truth_of_;
  std::vector<std::size_t> places_;  // of the observables of alone_
  std::vector<Member> members_;
};

}  // namespace

std::vector<int> seeds_on_curve(const Curve& curve, const std::vector<SeedsSoFar>& points,
                                const Target& target, int minimum, int maximum, const TruthOf& truth_of) {
  std::vector<int> most(curve.points.size(), 0);
  for (const Criterion& criterion : target.criteria()) {
    CriterionForecast forecast(criterion, target, minimum, maximum, truth_of);
    for (std::size_t k = 0; k < curve.points.size(); ++k)
      forecast.add(curve.axis[k], points[curve.points[k]]);
    std::ranges::transform(most, forecast.seeds(), most.begin(),
                           [](int one, int other) { return std::max(one, other); });
  }
  return most;
}

}  // namespace peclet::runner
