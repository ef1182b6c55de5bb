// Numbers, durations and dates as people read them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace peclet::runner {

// Numbers as people want to read them: no more digits than their errors justify, "-" for what does not exist.
//
// "8.93 ± 0.12": the error to two significant digits, the value to the same place. "8.9 ± -" when there is no
// error yet (NaN), "-" when there is no value either.
std::string with_error(double value, double error);

// "3.0 %", "12 %" of a fraction.
std::string percent(double fraction);

// "1 seed", "3 seeds".
std::string counted(std::size_t number, const char* noun);

// "8 to 100"; "16" for equal ones.
std::string range_text(int least, int most);

// Three significant digits at most: "0.017", "1.2e+06".
std::string rough(double number);

// Spans of time in words.
constexpr double seconds_per_hour = 3600;

// "45 s", "12 min", "3 h 20 min", "2 d 4 h"
std::string duration_text(double seconds);

// Wall-clock time, for people; nothing is decided by it.
//
// "2026-01-31T12:00:00Z"
std::string utc_now();

// Returns the seconds since 1970 at such a time; 0 if the text is none.
std::int64_t seconds_of_utc(const std::string& time);

}  // namespace peclet::runner
