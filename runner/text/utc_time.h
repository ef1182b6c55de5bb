// Wall-clock time, for people; nothing is decided by it.
#pragma once

#include <string>

namespace peclet::runner {

// "2026-01-31T12:00:00Z"
std::string utc_now();

}  // namespace peclet::runner
