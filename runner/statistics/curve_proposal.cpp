#include "runner/statistics/curve_proposal.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <cstdlib>

namespace peclet::runner {
namespace {

// A place where the band is looked at, and what a seed there is like.
struct Place {
  double axis = 0;
  bool is_new = true;
  int seeds = 0;        // ended; 0 at a new place
  double variance = 0;  // of the logarithm of one seed's value
  double cost = 0;      // of one seed
};

constexpr int parts = 4;  // of the distance between neighbours

// Returns a number that people would choose: with two significant digits.
double round_number(double number) { return std::strtod(fmt::format("{:.1e}", number).c_str(), nullptr); }

double between(double one, double other, double share, bool is_logarithmic) {
  if (!is_logarithmic) return one + share * (other - one);
  return std::exp(std::log(one) + share * (std::log(other) - std::log(one)));
}

// Returns the points, and the places between those that are not at rest.
std::vector<Place> places_of(std::vector<KnownOnCurve> points, bool is_even) {
  std::ranges::sort(points, {}, [](const KnownOnCurve& point) { return point.datum.axis; });
  std::vector<Place> places;
  for (const KnownOnCurve& point : points) {
    const CurveFit::Datum& datum = point.datum;
    const Place own{datum.axis, false, point.seeds, datum.count * CurveFit::variance(datum), point.cost};
    const bool has_neighbour = !places.empty() && !(is_even && places.back().axis == 0);
    if (has_neighbour) {
      const Place before = places.back();
      const bool is_logarithmic = before.axis > 0;
      for (int part = 1; part < parts; ++part) {
        const double share = static_cast<double>(part) / parts;
        const double axis = round_number(between(before.axis, own.axis, share, is_logarithmic));
        if (!(places.back().axis < axis && axis < own.axis)) continue;
        places.push_back({axis, true, 0, between(before.variance, own.variance, share, true),
                          between(before.cost, own.cost, share, true)});
      }
    }
    places.push_back(own);
  }
  return places;
}

// Returns what the last stop tests say of a curve's points, for the criterion at `place`; nothing if one of
// them contradicts the curve.
std::vector<KnownOnCurve> known_to(const Scheduler& scheduler, const Curve& curve, std::size_t place) {
  std::vector<KnownOnCurve> known;
  bool is_known = true;
  for (std::size_t k = 0; k < curve.points.size(); ++k) {
    const int point = static_cast<int>(curve.points[k]);
    if (scheduler.stop_tests(point).empty()) continue;
    const StopTest& last = scheduler.stop_tests(point).back();
    const ObservableStopTest& one = last.each[place];
    if (one.curve->refused) return {};
    if (!CurveFit::takes(one.estimate)) continue;
    const double work = scheduler.work_on_curve(point);
    is_known = is_known && work > 0;
    known.push_back({{curve.axis[k], one.estimate.mean, one.estimate.standard_error, one.estimate.count},
                     last.seeds,
                     work});
  }
  if (!is_known) std::ranges::for_each(known, [](KnownOnCurve& point) { point.cost = 1; });
  return known;
}

}  // namespace

std::optional<CurvePlan> plan_curve(const std::vector<KnownOnCurve>& points, bool is_even,
                                    const std::vector<int>& schedule, double confidence,
                                    const ProposalBounds& bounds) {
  std::vector<CurveFit::Datum> data(points.size());
  std::ranges::transform(points, data.begin(), &KnownOnCurve::datum);
  const std::optional<CurveFit::Through> through = CurveFit::through(data, is_even);
  if (!through) return {};
  std::vector<KnownOnCurve> used;
  for (const std::size_t datum : through->data) used.push_back(points[datum]);
  std::vector<Place> places = places_of(std::move(used), is_even);
  std::vector<double> axes(places.size());
  std::ranges::transform(places, axes.begin(), &Place::axis);
  CurveFit::Outlook outlook = through->fit.outlook(axes);
  const double normal = boost::math::quantile(boost::math::normal(), (1 + confidence) / 2);
  const auto width_at = [&](Eigen::Index place) {
    return std::expm1(normal * std::sqrt(std::max(0.0, outlook.variances()[place])));
  };
  const auto widest = [&] {
    Eigen::Index place = 0;
    outlook.variances().maxCoeff(&place);
    return place;
  };
  Eigen::Index worst = widest();
  CurvePlan plan{width_at(worst), axes[static_cast<std::size_t>(worst)]};
  double cost = 0;
  int new_points = 0;
  for (int step = 0; step < bounds.steps && width_at(worst) > bounds.width; ++step) {
    const auto seeds_after = [&](const Place& place) {
      return *std::upper_bound(schedule.begin(), schedule.end() - 1, place.seeds);
    };
    std::vector<std::optional<CurveFit::Outlook::Offer>> offers;
    for (const Place& place : places) {
      offers.emplace_back();
      const int more = seeds_after(place) - place.seeds;
      if (more <= 0 || !(place.is_new ? bounds.new_points > 0 : bounds.old_points)) continue;
      if (bounds.cost && cost + more * place.cost > *bounds.cost) continue;
      offers.back() = {place.variance / more, more * place.cost};
    }
    const std::size_t best = outlook.best(offers)[static_cast<std::size_t>(worst)];
    const auto is_further = [&](const Place& place) { return place.is_new && place.seeds == 0; };
    if (!offers[best] || (is_further(places[best]) && new_points == bounds.new_points)) break;
    Place& chosen = places[best];
    const int after = seeds_after(chosen), more = after - chosen.seeds;
    const double widest_at = axes[static_cast<std::size_t>(worst)];
    new_points += is_further(chosen) ? 1 : 0;
    outlook.take(best, chosen.variance / more);
    cost += more * chosen.cost;
    worst = widest();
    plan.proposals.push_back(
        {chosen.axis, chosen.is_new, chosen.seeds, after, more * chosen.cost, width_at(worst), widest_at});
    chosen.seeds = after;
  }
  for (std::size_t k = 0; k < places.size(); ++k) {
    if (places[k].seeds > 0)
      plan.width_at_points = std::max(plan.width_at_points, width_at(static_cast<Eigen::Index>(k)));
  }
  return plan;
}

std::optional<ChosenValue> choose_value(const Scheduler& scheduler, const Campaign& campaign) {
  if (campaign.most_values == 0 || std::ssize(campaign.curves.front().axis) >= campaign.most_values)
    return {};
  for (int point = 0; point < scheduler.points(); ++point) {
    if (!scheduler.decided(point) && !scheduler.cancelled(point)) return {};
  }
  const std::vector<int> schedule =
      stop_test_schedule(campaign.minimum_realisations, campaign.maximum_realisations);
  const double confidence = adjusted_confidence(campaign.target.confidence, campaign.minimum_realisations,
                                                campaign.maximum_realisations);
  const std::vector<Criterion> criteria = campaign.target.criteria();
  std::optional<ChosenValue> chosen;
  double largest_share = 1;
  for (const Curve& curve : campaign.curves) {
    for (std::size_t place = 0; place < criteria.size(); ++place) {
      const Tolerance& tolerance = criteria[place].tolerance;
      if (!tolerance.is_of_curve()) continue;
      const std::optional<CurvePlan> plan =
          plan_curve(known_to(scheduler, curve, place), tolerance.is_even, schedule, confidence,
                     {.width = tolerance.value, .new_points = 1, .old_points = false, .steps = 1});
      if (!plan || plan->proposals.empty() || !(plan->width / tolerance.value > largest_share)) continue;
      largest_share = plan->width / tolerance.value;
      chosen = {plan->proposals.front().axis, criteria[place].observable, plan->width};
    }
  }
  return chosen;
}

}  // namespace peclet::runner
