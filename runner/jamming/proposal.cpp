#include "runner/jamming/proposal.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "contract/input_error.h"

namespace peclet::runner {
namespace {

constexpr double finest = 1e-4;     // decimals of a proposed fraction
constexpr double nearest = 0.0015;  // to a point of the campaign, of one for the law
constexpr std::size_t most_points = 20;

double rounded(double fraction) { return std::round(fraction / finest) * finest; }
// 0.61 in the place of 0.6100000000000001: what is written is what is meant.
double as_written(double fraction) { return std::stod(fmt::format("{:.4f}", fraction)); }

class Neighbours {
 public:
  Neighbours(const JammingCurve& curve, const std::vector<double>& proposed) : taken_(proposed) {
    for (const JammingPoint& point : curve.points) taken_.push_back(point.fraction);
    std::sort(taken_.begin(), taken_.end());
  }
  bool is_free(double fraction, double distance) const {
    return fraction > 0 && fraction < 1 && std::none_of(taken_.begin(), taken_.end(), [&](double other) {
             return std::abs(other - fraction) < distance;
           });
  }
  // The middle of the widest gap between neighbours from `low` to `high`; none narrower than `least`.
  std::optional<double> widest_gap(double low, double high, double least) const {
    std::optional<double> found;
    for (std::size_t i = 0; i + 1 < taken_.size(); ++i) {
      const double width = taken_[i + 1] - taken_[i];
      if (taken_[i] < low - finest || taken_[i + 1] > high + finest || width < least) continue;
      found = 0.5 * (taken_[i] + taken_[i + 1]);
      least = width * (1 + 1e-9);
    }
    return found;
  }

 private:
  std::vector<double> taken_;
};

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

// The standard error of phi_m that points at these fractions give, by the slopes of the law.
double error_of(const Law& law, const LawForm& form, const std::vector<double>& fractions,
                const std::vector<double>& weights) {
  const double jamming = law.fraction.value;
  std::vector<double> x, g;
  for (const double phi : fractions) {
    x.push_back(-std::log1p(-phi / jamming));
    g.push_back(-law.exponent.value * phi / (jamming * (jamming - phi)));
  }
  return 1 / std::sqrt(weighted_line(x, g, weights, {!form.unit_prefactor, !form.exponent}).chi_squared);
}

std::optional<ProposedPoint> best_of_law(const JammingEstimate& estimate, const LawForm& form,
                                         const std::vector<double>& proposed) {
  const Law& law = *estimate.law.law;
  const JammingPoint* const stuck = estimate.curve.smallest_stuck();
  const double error = law.fraction.standard_error;
  const double jamming = law.fraction.value, flowing = *estimate.curve.largest_flowing();
  double last = std::min(jamming - 2 * error, 0.5 * (flowing + jamming));
  if (stuck != nullptr) last = std::min(last, stuck->fraction - nearest);
  std::vector<double> fractions, of_points = weights(estimate.fitted);
  for (const LawPoint& point : estimate.fitted) fractions.push_back(point.fraction);
  const double usual = median(of_points);
  for (const double fraction : proposed) {
    if (fraction <= last) {
      fractions.push_back(fraction);
      of_points.push_back(usual);
    }
  }
  const double now = error_of(law, form, fractions, of_points);
  const Neighbours neighbours(estimate.curve, proposed);
  fractions.push_back(0);
  of_points.push_back(usual);
  std::optional<double> best;
  double least = now;
  for (double phi = estimate.fitted.front().fraction; phi <= last; phi += 0.001) {
    if (!neighbours.is_free(rounded(phi), nearest)) continue;
    fractions.back() = rounded(phi);
    const double then = error_of(law, form, fractions, of_points);
    if (then >= least) continue;
    least = then;
    best = as_written(phi);
  }
  if (!best) return std::nullopt;
  return ProposedPoint{
      *best, fmt::format("lessens the error of the law's phi_m most, to {:.0f} % of it", 100 * least / now)};
}

// Between what flows and what does not, or on the way to either.
std::optional<ProposedPoint> bisection(const JammingEstimate& estimate, const std::vector<double>& proposed) {
  const JammingCurve& curve = estimate.curve;
  const Neighbours neighbours(curve, proposed);
  const std::optional<double> flowing = curve.largest_flowing();
  const JammingPoint* const stuck = curve.smallest_stuck();
  constexpr double fine_grid = 0.005, stride = 0.02;
  const auto made = [&](double fraction, const std::string& reason) -> std::optional<ProposedPoint> {
    if (!neighbours.is_free(fraction, finest / 2)) return std::nullopt;
    return ProposedPoint{as_written(fraction), reason};
  };
  if (flowing && stuck != nullptr) {
    if (const auto middle = neighbours.widest_gap(*flowing, stuck->fraction, fine_grid)) {
      return made(*middle, fmt::format("half-way between {:.6g}, which flows, and {:.6g}, which is {}",
                                       *flowing, stuck->fraction, to_string(stuck->state)));
    }
  }
  if (flowing && stuck == nullptr) {
    double beyond = *flowing;
    for (const double fraction : proposed) beyond = std::max(beyond, fraction);
    return made(beyond + stride, fmt::format("beyond {:.6g}, up to which all flows", *flowing));
  }
  if (!flowing) {
    double before = stuck != nullptr ? stuck->fraction : 0;
    for (const double fraction : proposed) before = std::min(before, fraction);
    return made(before - stride, "below all that is known, as nothing flows yet");
  }
  if (estimate.fitted.empty()) return std::nullopt;
  if (const auto middle = neighbours.widest_gap(estimate.fitted.front().fraction, *flowing, fine_grid))
    return made(*middle, "in the widest gap of what flows near jamming");
  return std::nullopt;
}

// Of one more point: for each curve what its dearest point took.
double cost_of(const std::vector<JammingEstimate>& estimates) {
  double sum = 0;
  for (const JammingEstimate& estimate : estimates) {
    double dearest = 0;
    for (const JammingPoint& point : estimate.curve.points) dearest = std::max(dearest, point.cpu_seconds);
    sum += dearest;
  }
  return sum;
}

Json row_of(const Json& entry, double fraction) {
  return entry.at("set").is_string() ? Json(fraction) : Json::array({fraction});
}

}  // namespace

std::optional<ProposedPoint> next_fraction(const JammingEstimate& estimate, const LawForm& form,
                                           const std::vector<double>& proposed) {
  if (estimate.law.law) {
    if (auto found = best_of_law(estimate, form, proposed)) return found;
  }
  return bisection(estimate, proposed);
}

ProposedPoints propose_points(const std::vector<JammingEstimate>& estimates, const LawForm& form,
                              std::optional<double> cpu_seconds) {
  ProposedPoints made;
  made.cpu_seconds = cost_of(estimates);
  std::size_t most = std::min(most_points, estimates.size());
  if (cpu_seconds) {
    const double affordable = made.cpu_seconds > 0 ? std::floor(*cpu_seconds / made.cpu_seconds) : 1;
    most = static_cast<std::size_t>(std::min(static_cast<double>(most_points), affordable));
    if (most == 0) {
      made.obstacle = fmt::format(
          "a point takes some {:.3g} s of processor time, as the dearest has: more than "
          "the budget",
          made.cpu_seconds);
      return made;
    }
  }
  std::vector<double> fractions;
  for (bool any = true; any && made.points.size() < most;) {
    any = false;
    for (const JammingEstimate& estimate : estimates) {
      if (made.points.size() == most) break;
      std::optional<ProposedPoint> found = next_fraction(estimate, form, fractions);
      if (!found) continue;
      any = true;
      fractions.push_back(found->fraction);
      if (!estimate.curve.name.empty()) found->reason = estimate.curve.name + ": " + found->reason;
      made.points.push_back(*std::move(found));
    }
  }
  if (made.points.empty()) made.obstacle = "no fraction would make phi_m better known: more seeds would";
  return made;
}

SweepChange add_to_sweep(const Json& sweep, const std::string& over, const std::vector<ProposedPoint>& points,
                         const std::string& file) {
  for (std::size_t place = 0; place < sweep.size(); ++place) {
    const Json& set = sweep[place].at("set");
    const Json pointers = set.is_string() ? Json::array({set}) : set;
    if (std::find(pointers.begin(), pointers.end(), Json(over)) == pointers.end()) continue;
    if (pointers.size() > 1) {
      throw InputError(file, fmt::format("/sweep/{}/set", place), set.dump(),
                       "sets the fraction in step with others, whose values at new fractions are yours to "
                       "choose: add the rows by hand");
    }
    SweepChange made{Json::array(), sweep};
    for (const ProposedPoint& point : points) {
      const Json row = row_of(sweep[place], point.fraction);
      made.patch.push_back(
          {{"op", "add"}, {"path", fmt::format("/sweep/{}/values/-", place)}, {"value", row}});
      made.sweep[place]["values"].push_back(row);
    }
    return made;
  }
  throw InputError(file, "/sweep", over, "is set by no entry");
}

}  // namespace peclet::runner
