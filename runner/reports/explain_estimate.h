// What `peclet explain` says of an estimate: how far its interval can be trusted, what the control variate
// does for it, and whether longer windows would be cheaper than more seeds.
#pragma once

#include <string>

#include "runner/store/database_summary.h"

namespace peclet::runner {

// Lines of the last look at a point; nothing before the first one.
std::string estimate_text(Database& database, const PointSummary& point, const TargetRecord& target);

}  // namespace peclet::runner
