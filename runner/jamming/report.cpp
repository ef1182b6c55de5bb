#include "runner/jamming/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "runner/statistics/look_json.h"
#include "runner/text/folded_text.h"
#include "runner/text/number_text.h"
#include "runner/text/text_table.h"

namespace peclet::runner {
namespace {

constexpr std::size_t page_width = 100;

std::string fraction_or_none(const std::optional<double>& fraction) {
  return fraction ? fmt::format("{:.6g}", *fraction) : "-";
}

std::string given_or_measured(const Measured& number) {
  return number.standard_error > 0 ? with_error(number.value, number.standard_error)
                                   : fmt::format("{:.6g} (given)", number.value);
}

std::string stuck_text(const JammingCurve& curve) {
  const JammingPoint* const stuck = curve.smallest_stuck();
  return stuck == nullptr ? "-" : fmt::format("{:.6g} {}", stuck->fraction, to_string(stuck->state));
}

void add_law_cells(std::vector<std::string>& row, const LawAnswer& answer) {
  if (!answer.law) {
    row.insert(row.end(), {"not determined", "-", "-", "-", "-"});
    return;
  }
  const Law& law = *answer.law;
  const auto digits = [&](double end) { return fmt::format("{:.4f}", end); };
  row.push_back(with_error(law.fraction.value, law.fraction.standard_error));
  row.push_back(fmt::format("{} to {}", digits(law.low), digits(law.high)));
  row.push_back(given_or_measured(law.exponent));
  row.push_back(given_or_measured(law.prefactor));
  row.push_back(fmt::format("{:.2f}/{}", law.chi_squared, law.degrees));
}

std::string steepest_text(const SteepestAnswer& answer) {
  if (!answer.steepest) return "not determined";
  return with_error(answer.steepest->fraction.value, answer.steepest->fraction.standard_error) +
         (answer.steepest->to_jammed ? " *" : "");
}

std::vector<std::string> cells(const JammingReport& report, const JammingEstimate& one, bool named) {
  std::vector<std::string> row;
  if (named) row.push_back(one.curve.name);
  row.push_back(fmt::format("{}", one.flowing()));
  row.push_back(fraction_or_none(one.curve.largest_flowing()));
  row.push_back(stuck_text(one.curve));
  if (report.by_law) add_law_cells(row, one.law);
  if (report.by_steepest) row.push_back(steepest_text(one.steepest));
  return row;
}

bool has_names(const JammingReport& report) {
  return std::any_of(report.estimates.begin(), report.estimates.end(),
                     [](const JammingEstimate& one) { return !one.curve.name.empty(); });
}

TextTable table_of(const JammingReport& report) {
  const bool named = has_names(report);
  TextTable table;
  if (named) table.add_column("curve", TextTable::Align::left);
  table.add_column("flowing");
  table.add_column("up to");
  table.add_column("stuck at", TextTable::Align::left);
  if (report.by_law) {
    table.add_column("phi_m by law", TextTable::Align::left);
    for (const char* const title : {"95 % interval", "exponent", "prefactor", "chi^2/degrees"})
      table.add_column(title, TextTable::Align::left);
  }
  if (report.by_steepest) table.add_column("phi_m by steepest rise", TextTable::Align::left);
  for (const JammingEstimate& one : report.estimates) table.add_row(cells(report, one, named));
  return table;
}

// Of one kind: the curves of which it is true, each with its places.
struct SharedRemark {
  std::string what;
  std::vector<std::pair<const JammingEstimate*, std::string>> of;
};

class SharedRemarks {
 public:
  void add(const JammingEstimate& one, const JammingRemark& remark) {
    auto same = std::find_if(remarks_.begin(), remarks_.end(),
                             [&](const SharedRemark& shared) { return shared.what == remark.what; });
    if (same == remarks_.end()) same = remarks_.insert(same, {remark.what, {}});
    if (same->of.empty() || same->of.back().first != &one) {
      same->of.emplace_back(&one, remark.place);
    } else {
      same->of.back().second += ", " + remark.place;
    }
  }

  std::string text(std::size_t curves) const {
    std::string text;
    for (const SharedRemark& remark : remarks_)
      text += folded(remark.what + where(remark, curves), page_width);
    return text;
  }

 private:
  static std::string where(const SharedRemark& remark, std::size_t curves) {
    const bool placed =
        std::any_of(remark.of.begin(), remark.of.end(), [](const auto& one) { return !one.second.empty(); });
    if (remark.of.size() == curves && !placed) return curves > 1 ? ": every curve\n" : "\n";
    if (curves == 1) return ": " + remark.of.front().second + '\n';
    std::string text = ":\n";
    for (const auto& [one, place] : remark.of)
      text += "  " + one->curve.name + (place.empty() ? "" : ": " + place) + '\n';
    return text;
  }

  std::vector<SharedRemark> remarks_;
};

std::string remarks_text(const JammingReport& report) {
  SharedRemarks remarks;
  for (const JammingEstimate& one : report.estimates) {
    if (report.by_law && !one.law.law)
      remarks.add(one, {"phi_m by law is not determined, " + one.law.obstacle, ""});
    if (report.by_steepest && !one.steepest.steepest)
      remarks.add(one, {"phi_m by steepest rise is not determined, " + one.steepest.obstacle, ""});
    for (const JammingRemark& remark : one.remarks) remarks.add(one, remark);
  }
  const std::string text = remarks.text(report.estimates.size());
  return text.empty() ? "" : '\n' + text;
}

std::string common_text(const CommonAnswer& answer) {
  if (!answer.common) return "exponent: " + answer.obstacle + '\n';
  const CommonExponent& common = *answer.common;
  return fmt::format("exponent: common to {}, {}; chi^2/degrees {:.2f}/{}\n",
                     counted(static_cast<std::size_t>(common.curves), "curve"),
                     with_error(common.exponent.value, common.exponent.standard_error), common.chi_squared,
                     common.degrees);
}

std::string legend(const JammingReport& report) {
  std::string text = fmt::format(
      "flowing: points that flow; stuck at: the smallest fraction beyond them that is jammed, or soft "
      "(mean overlap above {:g} radii); numbers ± standard error\n",
      report.softest);
  if (report.by_law) {
    text += fmt::format("law: prefactor (1 - phi / phi_m)^-exponent through flowing points above {:g}\n",
                        report.choice.above);
  }
  if (report.choice.common_exponent) text += common_text(report.common);
  const bool any_bracket =
      report.by_steepest &&
      std::any_of(report.estimates.begin(), report.estimates.end(), [](const JammingEstimate& one) {
        return one.steepest.steepest && one.steepest.steepest->to_jammed;
      });
  if (any_bracket) text += "*: between the last point that flows and the first one that is jammed\n";
  text +=
      "Whether a viscosity would grow with the stiffness, as that of a jammed point does, no single point "
      "can "
      "tell: sweep the stiffness.\n";
  return folded(text, page_width);
}

std::string proposal_text(const ProposedPoints& proposed) {
  std::string text = "\n";
  for (const ProposedPoint& point : proposed.points)
    text += folded(fmt::format("next: {:.6g}, {}\n", point.fraction, point.reason), page_width);
  if (!proposed.obstacle.empty()) text += folded("next: " + proposed.obstacle + '\n', page_width);
  if (proposed.points.empty()) return text;
  text += fmt::format("each takes some {:.3g} s of processor time, over all curves\n", proposed.cpu_seconds);
  return text + "patch of the campaign file (RFC 6902):\n" + proposed.patch.dump(2) + '\n';
}

Json json_or_null(const std::optional<double>& number) { return number ? Json(*number) : Json(nullptr); }

Json measured_json(const Measured& number) {
  return {{"value", number.value}, {"standard_error", number.standard_error}};
}

Json law_json(const LawAnswer& answer) {
  if (!answer.law) return {{"phi_m", nullptr}, {"obstacle", answer.obstacle}};
  const Law& law = *answer.law;
  return {{"phi_m", measured_json(law.fraction)},
          {"interval", {law.low, law.high}},
          {"exponent", measured_json(law.exponent)},
          {"prefactor", measured_json(law.prefactor)},
          {"chi_squared", law.chi_squared},
          {"degrees", law.degrees},
          {"obstacle", nullptr}};
}

Json steepest_json(const SteepestAnswer& answer) {
  if (!answer.steepest) return {{"phi_m", nullptr}, {"obstacle", answer.obstacle}};
  return {{"phi_m", measured_json(answer.steepest->fraction)},
          {"width", answer.steepest->width},
          {"to_jammed", answer.steepest->to_jammed},
          {"obstacle", nullptr}};
}

Json point_json(const JammingPoint& point, const JammingEstimate& estimate) {
  const bool is_fitted = std::any_of(estimate.fitted.begin(), estimate.fitted.end(),
                                     [&](const LawPoint& one) { return one.fraction == point.fraction; });
  return {{"label", point.label},
          {"fraction", point.fraction},
          {"state", to_string(point.state)},
          {"mean", number_json(point.estimate.mean)},
          {"standard_error", number_json(point.estimate.standard_error)},
          {"count", point.estimate.count},
          {"seeds", point.ended},
          {"jammed", point.jammed},
          {"overlap", json_or_null(point.overlap)},
          {"largest_overlap", json_or_null(point.largest_overlap)},
          {"fitted", is_fitted}};
}

Json curve_json(const JammingReport& report, const JammingEstimate& one) {
  const std::optional<double> flowing = one.curve.largest_flowing();
  const JammingPoint* const stuck = one.curve.smallest_stuck();
  Json points = Json::array();
  for (const JammingPoint& point : one.curve.points) points.push_back(point_json(point, one));
  Json remarks = Json::array();
  for (const JammingRemark& remark : one.remarks) remarks.push_back(remark.text());
  Json json = {{"settings", one.curve.settings},
               {"flowing", one.flowing()},
               {"largest_flowing", json_or_null(flowing)},
               {"smallest_stuck", nullptr},
               {"remarks", remarks},
               {"points", points}};
  if (stuck != nullptr)
    json["smallest_stuck"] = {{"fraction", stuck->fraction}, {"state", to_string(stuck->state)}};
  if (report.by_law) json["law"] = law_json(one.law);
  if (report.by_steepest) json["steepest"] = steepest_json(one.steepest);
  return json;
}

Json common_json(const CommonAnswer& answer) {
  if (!answer.common) return {{"exponent", nullptr}, {"obstacle", answer.obstacle}};
  return {{"exponent", measured_json(answer.common->exponent)},
          {"curves", answer.common->curves},
          {"chi_squared", answer.common->chi_squared},
          {"degrees", answer.common->degrees},
          {"obstacle", nullptr}};
}

Json proposed_json(const ProposedPoints& proposed) {
  Json points = Json::array();
  for (const ProposedPoint& point : proposed.points)
    points.push_back({{"fraction", point.fraction}, {"reason", point.reason}});
  return {{"points", points},
          {"cpu_seconds", proposed.cpu_seconds},
          {"patch", proposed.patch},
          {"obstacle", proposed.obstacle.empty() ? Json(nullptr) : Json(proposed.obstacle)}};
}

}  // namespace

std::string jamming_table(const JammingReport& report) {
  return fmt::format("{}: {} over {}, {}\n\n", report.campaign.campaign, report.campaign.quantity,
                     report.campaign.over, counted(report.estimates.size(), "curve")) +
         table_of(report).text() + remarks_text(report) + '\n' + legend(report) +
         (report.proposed ? proposal_text(*report.proposed) : "");
}

Json jamming_json(const JammingReport& report) {
  Json curves = Json::array();
  for (const JammingEstimate& one : report.estimates) curves.push_back(curve_json(report, one));
  const LawForm& form = report.choice.form;
  return {{"schema_version", 1},
          {"campaign", report.campaign.campaign},
          {"quantity", report.campaign.quantity},
          {"over", report.campaign.over},
          {"above", report.choice.above},
          {"softest", report.softest},
          {"given",
           {{"exponent", json_or_null(form.exponent)},
            {"prefactor", form.unit_prefactor ? Json(1) : Json(nullptr)}}},
          {"common", report.choice.common_exponent ? common_json(report.common) : Json(nullptr)},
          {"curves", curves},
          {"proposed", report.proposed ? proposed_json(*report.proposed) : Json(nullptr)}};
}

}  // namespace peclet::runner
