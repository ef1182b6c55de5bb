// Formats numbers, durations and dates for people.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace peclet::runner {

// Returns "8.93 ± 0.12": the error to two significant digits, the value to the same place. Returns "8.9 ± -"
// without an error (NaN), and "-" without a value.
std::string with_error(double value, double error);

// Returns a fraction as "3.0 %" or "12 %"; "-" if it is not finite.
std::string percent(double fraction);

// Returns "1 seed", "3 seeds".
std::string counted(std::size_t number, const char* noun);

// Returns "8 to 100", or "16" for equal numbers.
std::string range_text(int least, int most);

// Returns at most three significant digits: "0.017", "1.2e+06"; "-" if the number is not finite.
std::string rough(double number);

constexpr double seconds_per_hour = 3600;

// Returns "45 s", "12 min", "3 h 20 min", "2 d 4 h".
std::string duration_text(double seconds);

// Returns the present time as "2026-01-31T12:00:00Z". It is for people; no decision depends on it.
std::string utc_now();

// Returns the seconds since 1970 at a time of this form; 0 for another text.
std::int64_t seconds_of_utc(const std::string& time);

}  // namespace peclet::runner
