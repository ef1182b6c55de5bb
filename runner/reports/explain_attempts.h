// What `peclet explain` says of lost seeds and of attempts that came to nothing.
#pragma once

#include <string>

#include "runner/store/database_summary.h"

namespace peclet::runner {

// "  lost: 2 overlap (seeds 3, 17)" for every cause, and why in the line below; nothing when no seed is lost.
std::string losses_text(Database& database, const PointSummary& point);

// How many attempts ended how, and the latest ones that count against their seed.
std::string attempts_text(Database& database, std::int64_t point);

}  // namespace peclet::runner
