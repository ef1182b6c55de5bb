#include "runner/jamming/estimate.h"

#include <fmt/format.h>

#include <algorithm>

namespace peclet::runner {
namespace {

std::optional<JammingRemark> why_left_out(const JammingPoint& point) {
  const auto remark = [&](std::string why, const std::string& detail = "") {
    return JammingRemark{"left out, " + std::move(why),
                         fmt::format("{:.6g}{}", point.fraction, detail.empty() ? "" : " (" + detail + ")")};
  };
  switch (point.state) {
    case FlowState::flowing:
      if (point.has_error()) return std::nullopt;
      return remark(fmt::format("no error yet, {} seeds with a value are needed", fewest_seeds),
                    fmt::format("{}", point.estimate.count));
    case FlowState::soft:
      return remark("soft, a larger normal_stiffness makes spheres harder",
                    fmt::format("overlap {:.2g}{}", point.overlap ? *point.overlap : *point.largest_overlap,
                                point.overlap ? "" : " at most"));
    case FlowState::partly_jammed:
      return remark("some seeds jammed and the mean is of those that happened to flow",
                    fmt::format("{} of {}", point.jammed, point.ended));
    case FlowState::lost:
      return remark("half of the seeds or more were lost, for other reasons than jamming");
    case FlowState::suspect:
      return remark("suspect, a seed gave two different results");
    case FlowState::open:
      return remark("no seed has ended yet");
    case FlowState::jammed:
      break;  // has its column
  }
  return std::nullopt;
}

void add_contradictions(JammingEstimate& made) {
  const JammingPoint* const stuck = made.curve.smallest_stuck();
  for (const JammingPoint& point : made.curve.points) {
    if (point.state != FlowState::jammed || (stuck != nullptr && point.fraction >= stuck->fraction)) continue;
    made.remarks.push_back(
        {"jammed, although a larger fraction flows",
         fmt::format("{:.6g} (below {:.6g})", point.fraction, made.curve.largest_flowing().value_or(0))});
  }
  if (!made.law.law) return;
  const Law& law = *made.law.law;
  if (stuck != nullptr && stuck->state == FlowState::jammed && law.low > stuck->fraction) {
    made.remarks.push_back(
        {"the law diverges above a fraction that is jammed", fmt::format("{:.6g}", stuck->fraction)});
  }
  constexpr double poor = 3;
  if (law.chi_squared > poor * law.degrees) {
    made.remarks.push_back(
        {"the law does not describe the points, so its errors are made wider by the root of chi^2 per degree",
         ""});
  }
}

// Says why where there are too few points for one.
JammingEstimate without_law(const JammingCurve& curve, const EstimateChoice& choice) {
  JammingEstimate made{curve, {}, {}, {}, {}};
  std::vector<LawPoint> measured;
  for (const JammingPoint& point : curve.points) {
    if (std::optional<JammingRemark> why = why_left_out(point)) made.remarks.push_back(*std::move(why));
    if (!point.has_error()) continue;
    const bool flows = point.state == FlowState::flowing;
    if (flows || point.state == FlowState::soft) measured.push_back(point.law_point());
    if (flows && point.estimate.mean > choice.above) made.fitted.push_back(point.law_point());
  }
  if (!made.has_enough_points()) {
    made.law.obstacle = fmt::format("{} of the {} flowing points with a viscosity above {:g} that it needs",
                                    made.fitted.size(), fewest_points, choice.above);
  }
  const JammingPoint* const stuck = curve.smallest_stuck();
  const bool is_jammed = stuck != nullptr && stuck->state == FlowState::jammed;
  made.steepest = find_steepest(measured, is_jammed ? std::optional(stuck->fraction) : std::nullopt);
  return made;
}

}  // namespace

std::string JammingRemark::text() const { return place.empty() ? what : place + ": " + what; }

int JammingEstimate::flowing() const {
  return static_cast<int>(
      std::count_if(curve.points.begin(), curve.points.end(),
                    [](const JammingPoint& point) { return point.state == FlowState::flowing; }));
}

bool JammingEstimate::has_enough_points() const { return fitted.size() >= fewest_points; }

JammingEstimate estimate_jamming(const JammingCurve& curve, const EstimateChoice& choice) {
  JammingEstimate made = without_law(curve, choice);
  if (made.has_enough_points()) made.law = fit_law(made.fitted, choice.form, *curve.largest_flowing());
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
    if (one.has_enough_points()) fitted.push_back({one.fitted, *curve.largest_flowing()});
  }
  made.common = fit_common_law(fitted, choice.form);
  auto law = made.common.laws.begin();
  for (JammingEstimate& one : made.curves) {
    if (one.has_enough_points()) one.law = *law++;
    add_contradictions(one);
  }
  return made;
}

}  // namespace peclet::runner
