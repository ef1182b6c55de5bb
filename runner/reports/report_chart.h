// The chart of a report: which swept variable is drawn along the axis, and which make series.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runner/database/database_summary.h"
#include "runner/text/svg_chart.h"

namespace peclet::runner {

struct ReportChart {
  std::optional<Chart> chart;
  std::string note;  // why there is none, or what it leaves out; a sentence, or nothing
};

// The estimate that decides, at each point's last look (before the first one, the mean so far), over the
// variable of the sweep that is a number everywhere and has most values; among equals the first. What else
// the sweep varies makes series, but for variables that are set in step with that one.
ReportChart report_chart(const std::vector<PointSummary>& points, const std::string& observable);

}  // namespace peclet::runner
