// What `peclet explain` says of an estimate: how far its interval can be trusted, what the control variate
// does for it, and whether longer windows would be cheaper than more seeds.
#pragma once

#include <string>

#include "runner/store/database_summary.h"

namespace peclet::runner {

// Lines of the last look at a point; nothing before the first one.
std::string estimate_text(Database& database, const PointSummary& point, const TargetRecord& target);

// What `peclet explain` says of lost seeds and of attempts that came to nothing.
//
// "  lost: 2 overlap (seeds 3, 17)" for every cause, and why in the line below; nothing when no seed is lost.
std::string losses_text(Database& database, const PointSummary& point);

// How many attempts ended how, and the latest ones that count against their seed.
std::string attempts_text(Database& database, std::int64_t point);

}  // namespace peclet::runner
