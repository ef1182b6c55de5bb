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
  double seconds = 0;   // of one seed
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
    const Place own{datum.axis, false, point.seeds, datum.count * CurveFit::variance(datum), point.seconds};
    const bool has_neighbour = !places.empty() && !(is_even && places.back().axis == 0);
    if (has_neighbour) {
      const Place before = places.back();
      const bool is_logarithmic = before.axis > 0;
      for (int part = 1; part < parts; ++part) {
        const double share = static_cast<double>(part) / parts;
        const double axis = round_number(between(before.axis, own.axis, share, is_logarithmic));
        if (!(places.back().axis < axis && axis < own.axis)) continue;
        places.push_back({axis, true, 0, between(before.variance, own.variance, share, true),
                          between(before.seconds, own.seconds, share, true)});
      }
    }
    places.push_back(own);
  }
  return places;
}

}  // namespace

CurvePlan plan_curve(const std::vector<KnownOnCurve>& points, bool is_even, const std::vector<int>& schedule,
                     double confidence, const ProposalBounds& bounds) {
  std::vector<CurveFit::Datum> data(points.size());
  std::ranges::transform(points, data.begin(), &KnownOnCurve::datum);
  std::vector<Place> places = places_of(points, is_even);
  std::vector<double> axes(places.size());
  std::ranges::transform(places, axes.begin(), &Place::axis);
  CurveFit::Outlook outlook = CurveFit(data, is_even).outlook(axes);
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
  double seconds = 0;
  int new_points = 0;
  for (int step = 0; step < bounds.steps && width_at(worst) > bounds.width; ++step) {
    std::optional<std::size_t> best;
    double most = 0;
    const auto seeds_after = [&](const Place& place) {
      return *std::upper_bound(schedule.begin(), schedule.end() - 1, place.seeds);
    };
    for (std::size_t k = 0; k < places.size(); ++k) {
      const Place& place = places[k];
      const int more = seeds_after(place) - place.seeds;
      if (more <= 0 || (place.is_new && bounds.new_points == 0)) continue;
      if (bounds.seconds && seconds + more * place.seconds > *bounds.seconds) continue;
      const double gain = outlook.gain(k, place.variance / more)[worst] / (more * place.seconds);
      if (gain > most) {
        most = gain;
        best = k;
      }
    }
    const auto is_further = [&](const Place& place) { return place.is_new && place.seeds == 0; };
    if (!best || (is_further(places[*best]) && new_points == bounds.new_points)) break;
    Place& chosen = places[*best];
    const int after = seeds_after(chosen), more = after - chosen.seeds;
    const double widest_at = axes[static_cast<std::size_t>(worst)];
    new_points += is_further(chosen) ? 1 : 0;
    outlook.take(*best, chosen.variance / more);
    seconds += more * chosen.seconds;
    worst = widest();
    plan.proposals.push_back(
        {chosen.axis, chosen.is_new, chosen.seeds, after, more * chosen.seconds, width_at(worst), widest_at});
    chosen.seeds = after;
  }
  for (std::size_t k = 0; k < places.size(); ++k) {
    if (places[k].seeds > 0)
      plan.width_at_points = std::max(plan.width_at_points, width_at(static_cast<Eigen::Index>(k)));
  }
  return plan;
}

}  // namespace peclet::runner
