// Wall-clock time, for people; nothing is decided by it.
#pragma once

#include <cstdint>
#include <string>

namespace peclet::runner {

// "2026-01-31T12:00:00Z"
std::string utc_now();

// Returns the seconds since 1970 at such a time; 0 if the text is none.
std::int64_t seconds_of_utc(const std::string& time);

}  // namespace peclet::runner
