#include "runner/reports/report.h"

#include <fmt/format.h>

#include "contract/sha256.h"
#include "runner/reports/export.h"
#include "runner/reports/report_sections.h"
#include "runner/reports/status.h"
#include "runner/text/html.h"

namespace peclet::runner {
namespace {

// Colours that people with any kind of colour vision tell apart (M. Okabe and K. Ito, 2002), brighter on a
// dark page; prints are always light.
constexpr const char* style = R"(
:root { color-scheme: light dark; --page: #ffffff; --ink: #1b1b1b; --faint: #5f5f5f; --rule: #d4d4d4;
  --panel: #f5f5f5; --0: #0072b2; --1: #c44e00; --2: #00805c; --3: #a8487f; --4: #b07700; --5: #3a8fc0;
  --6: #6b6b00; --7: #1b1b1b; }
@media (prefers-color-scheme: dark) { :root { --page: #17191c; --ink: #e6e6e6; --faint: #a3a3a3;
  --rule: #3d4146; --panel: #212429; --0: #56b4e9; --1: #ff8f4d; --2: #2fc49a; --3: #e296c2; --4: #e6b13c;
  --5: #9ad0f2; --6: #d9d36a; --7: #e6e6e6; } }
body { background: var(--page); color: var(--ink); font: 16px/1.5 system-ui, sans-serif; max-width: 60rem;
  margin: 0 auto; padding: 1.5rem; }
h1 { font-size: 1.6rem; line-height: 1.2; margin: 0 0 .4rem; }
h2 { font-size: 1.15rem; margin: 2rem 0 .5rem; }
p { margin: .4rem 0; }
.faint, figcaption { color: var(--faint); font-size: .9rem; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: .25rem .8rem .25rem 0; text-align: right; border-bottom: 1px solid var(--rule);
  vertical-align: top; white-space: nowrap; }
th { font-weight: 600; } th.text, td.text { text-align: left; } td.text:last-child { white-space: normal; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: .15rem 1rem; margin: .4rem 0; }
@media (min-width: 50rem) { dl.scene { grid-template-columns: max-content 1fr max-content 1fr; } }
dt { color: var(--faint); } dd { margin: 0; overflow-wrap: anywhere; }
pre { background: var(--panel); border: 1px solid var(--rule); padding: .7rem .9rem; overflow-x: auto;
  font-size: .85rem; line-height: 1.4; white-space: pre-wrap; overflow-wrap: anywhere; }
figure { margin: 1.2rem 0 .5rem; } figure > svg { width: 100%; height: auto; }
svg text { fill: var(--ink); font: 13px system-ui, sans-serif; } svg text.title { font-size: 14px; }
.grid { stroke: var(--rule); stroke-width: .6; } .frame { fill: none; stroke: var(--faint); }
.bar { stroke-width: 1.4; } .guide { fill: none; stroke-width: 1; opacity: .45; }
.hollow { fill: var(--page); stroke-width: 1.8; } .mark { width: .9em; height: .9em; vertical-align: -.05em; }
.legend span { margin-right: 1.2rem; display: inline-block; }
.provisional { opacity: .6; } .provisional .bar { stroke-dasharray: 3 2; } .for-narrow { display: none; }
@media (max-width: 38rem) { body { padding: 1rem; } .for-narrow { display: inline; } .for-wide { display: none; }
  dl, dl.scene { display: block; } dd { margin: 0 0 .3rem 1rem; }
  table { font-size: .9rem; } th, td { padding-right: .6rem; } th { white-space: normal; }
  td.text:last-child { white-space: nowrap; } }
@media print { :root { color-scheme: light; --page: #ffffff; --ink: #000000; --faint: #444444;
  --rule: #bbbbbb; --panel: #ffffff; --0: #0072b2; --1: #c44e00; --2: #00805c; --3: #a8487f; --4: #b07700;
  --5: #3a8fc0; --6: #6b6b00; --7: #000000; } body { font-size: 10pt; max-width: none; padding: 0; }
  th, td { white-space: normal; }
  section, figure, tr { break-inside: avoid; } section.long { break-inside: auto; } }
)";

// The colour of everything that belongs to a series: lines are stroked with it, full marks filled.
std::string series_style() {
  std::string text;
  for (int i = 0; i < 8; ++i) {
    text += fmt::format(
        ".series-{0} * {{ stroke: var(--{0}); }} .series-{0} .solid {{ fill: var(--{0}); }}\n", i);
  }
  return text;
}

// What the engine says about each scene, from the first result of every point.
std::vector<Json> first_warnings(Database& database, const std::vector<PointSummary>& points) {
  std::vector<Json> warnings;
  for (const PointSummary& point : points) {
    Json found = Json::array();
    for (const RealisationRecord& record : database.realisations(point.point.id)) {
      if (record.state != SeedState::done) continue;
      if (const std::optional<Json> result = database.result(point.point.id, record.seed)) {
        found = result->value("warnings", Json::array());
        break;
      }
    }
    warnings.push_back(std::move(found));
  }
  return warnings;
}

}  // namespace

std::string report_html(Database& database) {
  const CampaignStatus status = read_status(database);
  const std::string canonical = sha256(export_json(database, true));  // checks every look as well
  const std::string name = escaped(status.campaign.name);
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         name + "</title>\n<style>" + style + series_style() + "</style>\n</head>\n<body>\n<h1>" + name +
         "</h1>\n" + question_section(status) + results_section(status) + losses_section(status) +
         remarks_section(status, first_warnings(database, status.points)) +
         provenance_section(database, status, canonical) + "</body>\n</html>\n";
}

}  // namespace peclet::runner
