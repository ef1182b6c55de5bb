#include "runner/jamming/estimate.h"

#include <fmt/format.h>

#include <algorithm>

namespace peclet::runner {
namespace {

std::string why_left_out(const JammingPoint& point) {
  switch (point.state) {
    case FlowState::flowing:
      return point.has_error() ? ""
                               : fmt::format("no error yet: {} of {} seeds with a value",
                                             point.estimate.count, fewest_seeds);
    case FlowState::soft:
      return fmt::format(
          "soft: spheres overlap by {:.2g} radii{}, more than hard ones would; a larger "
          "normal_stiffness makes them harder",
          point.overlap ? *point.overlap : *point.largest_overlap, point.overlap ? "" : " at most");
    case FlowState::partly_jammed:
      return fmt::format("{} of {} seeds jammed: the mean is of those that happened to flow", point.jammed,
                         point.ended);
    case FlowState::lost:
      return "half of its seeds or more were lost, for other reasons than jamming";
    case FlowState::suspect:
      return "suspect: a seed gave two different results";
    case FlowState::open:
      return "no seed has ended yet";
    case FlowState::jammed:
      break;  // has its column
  }
  return "";
}

void add_contradictions(JammingEstimate& made) {
  const JammingPoint* const stuck = made.curve.smallest_stuck();
  for (const JammingPoint& point : made.curve.points) {
    if (point.state != FlowState::jammed || (stuck != nullptr && point.fraction >= stuck->fraction)) continue;
    made.remarks.push_back(fmt::format("{:.6g} is jammed, although {:.6g} flows", point.fraction,
                                       made.curve.largest_flowing().value_or(0)));
  }
  if (!made.law.law) return;
  const Law& law = *made.law.law;
  if (stuck != nullptr && stuck->state == FlowState::jammed && law.low > stuck->fraction) {
    made.remarks.push_back(fmt::format("the law diverges above {:.6g}, which is jammed", stuck->fraction));
  }
  constexpr double poor = 3;
  if (law.chi_squared > poor * law.degrees) {
    made.remarks.emplace_back(
        "the law does not describe the points: its errors are made wider by the root of "
        "chi^2 per degree");
  }
}

// Its obstacle is there where too few points are.
JammingEstimate without_law(const JammingCurve& curve, const EstimateChoice& choice) {
  JammingEstimate made{curve, {}, {}, {}, {}};
  std::vector<LawPoint> measured;
  for (const JammingPoint& point : curve.points) {
    if (const std::string why = why_left_out(point); !why.empty())
      made.remarks.push_back(fmt::format("{:.6g} is left out: {}", point.fraction, why));
    if (!point.has_error()) continue;
    const bool flows = point.state == FlowState::flowing;
    if (flows || point.state == FlowState::soft) measured.push_back(point.law_point());
    if (flows && point.estimate.mean > choice.above) made.fitted.push_back(point.law_point());
  }
  if (made.fitted.size() < fewest_points) {
    made.law.obstacle = fmt::format("{} of the {} flowing points with a viscosity above {:g} that it needs",
                                    made.fitted.size(), fewest_points, choice.above);
  }
  const JammingPoint* const stuck = curve.smallest_stuck();
  const bool is_jammed = stuck != nullptr && stuck->state == FlowState::jammed;
  made.steepest = find_steepest(measured, is_jammed ? std::optional(stuck->fraction) : std::nullopt);
  return made;
}

}  // namespace

int JammingEstimate::flowing() const {
  return static_cast<int>(
      std::count_if(curve.points.begin(), curve.points.end(),
                    [](const JammingPoint& point) { return point.state == FlowState::flowing; }));
}

JammingEstimate estimate_jamming(const JammingCurve& curve, const EstimateChoice& choice) {
  JammingEstimate made = without_law(curve, choice);
  if (made.law.obstacle.empty()) made.law = fit_law(made.fitted, choice.form, *curve.largest_flowing());
  add_contradictions(made);
  return made;
}

JammingEstimates estimate_all(const std::vector<JammingCurve>& curves, const EstimateChoice& choice) {
  JammingEstimates made;
  if (!choice.common_exponent) {
    for (const JammingCurve& curve : curves) made.curves.push_back(estimate_jamming(curve, choice));
    return made;
  }
  std::vector<LawCurve> fitted;
  for (const JammingCurve& curve : curves) {
    made.curves.push_back(without_law(curve, choice));
    const JammingEstimate& one = made.curves.back();
    if (one.law.obstacle.empty()) fitted.push_back({one.fitted, *curve.largest_flowing()});
  }
  made.common = fit_common_law(fitted, choice.form);
  auto law = made.common.laws.begin();
  for (JammingEstimate& one : made.curves) {
    if (one.law.obstacle.empty()) one.law = *law++;
    add_contradictions(one);
  }
  return made;
}

}  // namespace peclet::runner
