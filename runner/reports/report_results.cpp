// The middle sections of a report: what was found, and what may be doubted.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "runner/reports/report_chart.h"
#include "runner/reports/report_sections.h"
#include "runner/text/duration_text.h"
#include "runner/text/html.h"
#include "runner/text/number_text.h"
#include "runner/text/point_columns.h"

namespace peclet::runner {
namespace {

std::string paragraph(const std::string& text) {
  return text.empty() ? "" : "<p class=\"faint\">" + escaped(text) + "</p>\n";
}

// Seeds have ended, and none has been looked at.
bool is_provisional(const PointSummary& point) { return point.looks.empty() && point.so_far.count > 0; }

std::vector<std::string> estimates(const PointSummary& point, bool with_control, const Tolerance& tolerance) {
  if (point.looks.empty()) {
    std::vector<std::string> cells(with_control ? 3 : 2, "-");
    if (is_provisional(point)) {
      cells.front() = with_error(point.so_far.mean, point.so_far.standard_error) + " so far";
    }
    return cells;
  }
  const Look& look = point.looks.back();
  std::vector<std::string> cells{with_error(look.controlled.mean, look.controlled_half_width),
                                 width_text(tolerance, look.controlled_half_width, look.controlled.mean)};
  if (with_control) cells.push_back(with_error(look.estimate.mean, look.half_width));
  return cells;
}

HtmlTable points_table(const CampaignStatus& status) {
  using Align = HtmlTable::Align;
  std::vector<std::string> labels;
  for (const PointSummary& point : status.points) labels.push_back(point.point.label);
  const PointColumns columns(labels);
  const bool with_control = any_control(status);
  HtmlTable table;
  for (const std::string& title : columns.titles()) {
    table.add_column(title, title == "point" ? Align::left : Align::right);
  }
  table.add_column("seeds");
  table.add_column(status.campaign.target.target.observable);
  const Tolerance& tolerance = status.campaign.target.target.tolerance;
  table.add_column(tolerance.is_relative() ? "relative" : "half-width");
  if (with_control) table.add_column("uncontrolled");
  table.add_column("lost");
  table.add_column("CPU time");
  table.add_column("verdict", Align::left);
  const bool any_marks = std::any_of(status.points.begin(), status.points.end(),
                                     [](const PointSummary& point) { return !reservations(point).empty(); });
  if (any_marks) table.add_column("marks", Align::left);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const PointSummary& point = status.points[i];
    std::vector<std::string> row = columns.cells(i);
    row.push_back(fmt::format("{}/{}", point.wanted_ended, point.wanted));
    for (std::string& cell : estimates(point, with_control, tolerance)) row.push_back(std::move(cell));
    row.push_back(fmt::format("{}", point.lost()));
    row.push_back(duration_text(point.counts.cpu_seconds));
    row.push_back(standing_word(point));
    if (any_marks) row.push_back(fmt::format("{}", fmt::join(reservations(point), ", ")));
    table.add_row(std::move(row));
  }
  return table;
}

std::string caption(const CampaignStatus& status) {
  const bool any_provisional = std::any_of(status.points.begin(), status.points.end(), is_provisional);
  return fmt::format(
      "Seeds: those that have ended, of those that the deciding look takes (of an open point, the next "
      "look). The value is the mean over the seeds of the last look, ± the half-width of its {:g} % "
      "interval{}.{}{}",
      100 * status.campaign.target.target.confidence,
      status.campaign.target.target.tolerance.is_relative() ? "; relative is the half-width over the mean"
                                                            : "",
      any_control(status) ? " Both are with the control variate, a quantity of known mean zero that "
                            "takes away scatter; uncontrolled is the same without it."
                          : "",
      any_provisional ? " So far: provisional, the mean ± standard error of the seeds that happen to have "
                        "ended, at a point that has not been looked at."
                      : "");
}

std::string legend(const Chart& chart) {
  std::string text;
  if (chart.series.size() > 1) {
    for (std::size_t i = 0; i < chart.series.size(); ++i) {
      text +=
          "<span>" + svg_mark(i, ChartPoint::Kind::decided) + ' ' + escaped(chart.series[i].name) + "</span>";
    }
  }
  const auto any = [&](ChartPoint::Kind kind) {
    return std::any_of(chart.series.begin(), chart.series.end(), [kind](const ChartSeries& series) {
      return std::any_of(series.points.begin(), series.points.end(),
                         [kind](const ChartPoint& point) { return point.kind == kind; });
    });
  };
  using Kind = ChartPoint::Kind;
  if (any(Kind::undecided)) text += "<span>" + svg_mark(0, Kind::undecided) + " not converged</span>";
  if (any(Kind::provisional)) {
    text += "<span class=\"provisional\">" + svg_mark(0, Kind::provisional) +
            " provisional: mean ± standard error so far</span>";
  }
  return text.empty() ? "" : "<div class=\"legend\">" + text + "</div>\n";
}

std::string figure(const CampaignStatus& status) {
  const ReportChart report = report_chart(status.points, status.campaign.target.target.observable);
  if (!report.chart) return paragraph(report.note);
  const double confidence = status.campaign.target.target.confidence;
  return "<figure>\n" + svg(*report.chart, ChartForm::wide) + svg(*report.chart, ChartForm::narrow) +
         legend(*report.chart) +
         fmt::format("<figcaption>Bars are the {:g} % intervals; lines only guide the eye. {}</figcaption>\n",
                     100 * confidence, escaped(report.note)) +
         "</figure>\n";
}

std::string totals(const CampaignStatus& status) {
  double cpu_seconds = 0;
  int ended = 0;
  for (const PointSummary& point : status.points) {
    cpu_seconds += point.counts.cpu_seconds;
    ended += point.counts.terminal();
  }
  return fmt::format("<p>{}. {} seeds ended, which took {} of processor time.</p>\n", point_totals(status),
                     ended, duration_text(cpu_seconds));
}

// What a mark of the table means; the marks are those of reservations() and the verdicts.
std::string meaning(const std::string& mark) {
  static const std::map<std::string, std::string> meanings{
      {"converged-with-losses",
       "the interval is within the tolerance, but the mean leaves out the seeds that were lost; if they were "
       "lost because of what they would have given, it is biased"},
      {"converged-near-maximum",
       "the interval is about as wide as the tolerance, but the seeds that are allowed are too few to tell "
       "whether by luck: the one that is given is wider, and holds the mean as often as it says"},
      {"capped", "all seeds that are allowed have ended, and the interval is still wider than the tolerance"},
      {"failed", "too many seeds were lost to give an interval"},
      {"open", "not decided yet: the numbers are provisional"},
      {"cancelled", "somebody decided that it gets no more seeds: the numbers stay provisional"},
      {"transient",
       "the beginning of the measured windows differs from their end: they begin before the equilibration is "
       "over, which more seeds do not mend"},
      {"no-transient-test",
       "the results have no blocks of the observable, so that nothing can tell whether the windows begin "
       "before the equilibration is over"},
      {"skewed",
       "some values are far from the rest on one side, and the interval holds the mean less often than it "
       "says"},
      {"earlier-look",
       "the target was tighter before: the first look within the present one decides, as if there had been "
       "no "
       "other, and leaves out seeds that ended later"},
      {"suspect", "a seed gave two different results; no number of this point can be trusted"},
      {"timestep", "seeds whose time step made too much energy, changes the stress or was often divided"},
      {"solver", "seeds whose implicit steps were solved too inaccurately"},
      {"overlap", "seeds in which spheres overlapped by more than a hundredth of a radius"}};
  const auto known = meanings.find(mark);
  return known == meanings.end() ? "the engine's own mark; its warning says more" : known->second;
}

}  // namespace

std::string results_section(const CampaignStatus& status) {
  return "<section class=\"long\">\n<h2>Results</h2>\n" + totals(status) + points_table(status).html() +
         paragraph(caption(status)) + figure(status) + "</section>\n";
}

std::string losses_section(const CampaignStatus& status) {
  HtmlTable table;
  table.add_column("point", HtmlTable::Align::left);
  table.add_column("cause", HtmlTable::Align::left);
  table.add_column("seeds");
  for (const PointSummary& point : status.points) {
    for (const auto& [cause, count] : point.losses) {
      table.add_row({point.point.label, cause, fmt::format("{}", count)});
    }
  }
  if (table.empty()) return "";
  return "<section>\n<h2>Lost seeds</h2>\n<p>Seeds that ended without a value. Means leave them out.</p>\n" +
         table.html() + "</section>\n";
}

std::string remarks_section(const CampaignStatus& status, const std::vector<Json>& warnings) {
  std::map<std::string, std::string> remarks;
  for (const PointSummary& point : status.points) {
    const std::string verdict = standing_word(point);
    if (verdict != to_string(Verdict::converged)) remarks[verdict] = meaning(verdict);
    for (const std::string& mark : reservations(point)) {
      const std::string code = mark.substr(mark.rfind(' ') + 1);
      remarks[code == mark ? mark : "flagged " + code] = meaning(code);
    }
  }
  std::string text;
  for (const auto& [mark, sense] : remarks) {
    text += "<dt>" + escaped(mark) + "</dt><dd>" + escaped(sense) + "</dd>\n";
  }
  HtmlTable said;
  said.add_column("point", HtmlTable::Align::left);
  said.add_column("the engine warns", HtmlTable::Align::left);
  for (std::size_t i = 0; i < warnings.size(); ++i) {
    for (const Json& warning : warnings[i]) {
      said.add_row({status.points[i].point.label,
                    fmt::format("{}: {}", warning.value("code", ""), warning.value("message", ""))});
    }
  }
  if (text.empty() && said.empty()) return "";
  return "<section>\n<h2>What to know before using the numbers</h2>\n" +
         (text.empty() ? "" : "<dl>\n" + text + "</dl>\n") + (said.empty() ? "" : said.html()) +
         "</section>\n";
}

}  // namespace peclet::runner
