// Spans of time in words.
#pragma once

#include <string>

namespace peclet::runner {

constexpr double seconds_per_hour = 3600;

// "45 s", "12 min", "3 h 20 min", "2 d 4 h"
std::string duration_text(double seconds);

}  // namespace peclet::runner
