#include "contract/decimal.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <string>
#include <version>

namespace peclet {
namespace {

// Returns the end of the decimal number at the beginning of [begin, end), such as "-1.5e-3". Returns `begin`
// if no digit is before the exponent.
const char* end_of_decimal(const char* begin, const char* end) {
  const auto after_digits = [end](const char* at) {
    return std::find_if(at, end, [](char c) { return c < '0' || c > '9'; });
  };
  const char* const whole = begin != end && *begin == '-' ? begin + 1 : begin;
  const char* last = after_digits(whole);
  bool has_digits = last != whole;
  if (last != end && *last == '.') {
    const char* const fraction = last + 1;
    last = after_digits(fraction);
    has_digits = has_digits || last != fraction;
  }
  if (!has_digits) return begin;
  if (last == end || (*last != 'e' && *last != 'E')) return last;
  const char* power = last + 1;
  if (power != end && (*power == '+' || *power == '-')) ++power;
  const char* const after_power = after_digits(power);
  return after_power == power ? last : after_power;
}

}  // namespace

std::from_chars_result read_double(const char* begin, const char* end, double& value) {
#ifdef __cpp_lib_to_chars
  double number = 0;
  const std::from_chars_result read = std::from_chars(begin, end, number);
  if (read.ec != std::errc()) return read;
  if (!std::isfinite(number)) return {begin, std::errc::invalid_argument};
  value = number;
  return read;
#else
  return read_double_by_strtod(begin, end, value);
#endif
}

std::from_chars_result read_double_by_strtod(const char* begin, const char* end, double& value) {
  const char* const stop = end_of_decimal(begin, end);
  if (stop == begin) return {begin, std::errc::invalid_argument};
  errno = 0;
  const double number = std::strtod(std::string(begin, stop).c_str(), nullptr);
  // ERANGE is also set for denormal numbers, which are in range.
  if (errno == ERANGE && (number == 0 || !std::isfinite(number)))
    return {stop, std::errc::result_out_of_range};
  value = number;
  return {stop, std::errc()};
}

double with_digits(double value, int digits) { return std::stod(fmt::format("{:.{}g}", value, digits)); }

}  // namespace peclet
