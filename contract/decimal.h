// Doubles and decimal digits, also where the C++ library has no std::from_chars() for doubles (libc++).
#pragma once

#include <charconv>

namespace peclet {

// Reads a decimal number from the beginning of [begin, end), as std::from_chars() does. "inf" and "nan" are
// no numbers here. After an error `value` is not changed.
std::from_chars_result read_double(const char* begin, const char* end, double& value);

// Does what read_double() does, by strtod() and in the locale "C". It is slower than std::from_chars().
std::from_chars_result read_double_by_strtod(const char* begin, const char* end, double& value);

// Returns the double nearest to the value with this many significant digits.
double with_digits(double value, int digits);

}  // namespace peclet
