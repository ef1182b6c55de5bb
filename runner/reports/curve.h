// A curve in a line of text, for terminals.
#pragma once

#include <cstddef>
#include <string>

#include "runner/reports/status.h"

namespace peclet::runner {

// The mean so far over the swept parameter that has the most values, a line for each combination of the
// others
// ("volume_fraction=0.45  ▁▁▂▂▄▄  5.39 to 8.52"), all on one scale, logarithmic where the means span a factor
// of five; a dot where there is no mean yet, × where the point has jammed. "" where there are fewer than
// three numbers to draw, or where the lines are longer than `width`.
std::string curve_text(const CampaignStatus& status, std::size_t width);

}  // namespace peclet::runner
