#include "runner/campaign/number_text.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <ctime>

namespace peclet::runner {
namespace {

// Returns the power of ten of a number that is rounded to two digits: -1 for 0.0996, which is 1.0e-01.
int exponent(double number) {
  const std::string text = fmt::format("{:.1e}", number);
  return std::atoi(text.c_str() + text.find('e') + 1);
}

// Returns the number rounded to a multiple of 10^-decimals; `decimals` may be negative.
std::string rounded(double number, int decimals) {
  if (decimals >= 0) return fmt::format("{:.{}f}", number, decimals);
  const double unit = std::pow(10.0, -decimals);
  return fmt::format("{:.0f}", std::round(number / unit) * unit);
}

}  // namespace

std::string with_error(double value, double error) {
  if (!std::isfinite(value)) return "-";
  if (!std::isfinite(error)) return fmt::format("{} ± -", rough(value));
  if (error <= 0) return fmt::format("{:.6g} ± 0", value);
  const int decimals = 1 - exponent(error);
  const bool is_plain = decimals <= 5 && std::abs(value) < 1e6 && error < 1e6;
  if (is_plain) return fmt::format("{} ± {}", rounded(value, decimals), rounded(error, decimals));
  const int power = exponent(std::max(std::abs(value), error));
  const double unit = std::pow(10.0, power);
  return fmt::format("({} ± {})e{}", rounded(value / unit, decimals + power),
                     rounded(error / unit, decimals + power), power);
}

std::string counted(std::size_t number, const char* noun) {
  return fmt::format("{} {}{}", number, noun, number == 1 ? "" : "s");
}

std::string range_text(int least, int most) {
  return least == most ? fmt::format("{}", least) : fmt::format("{} to {}", least, most);
}

std::string percent(double fraction) {
  if (!std::isfinite(fraction)) return "-";
  return fmt::format("{:.{}f} %", 100 * fraction, fraction < 0.0995 ? 1 : 0);
}

std::string rough(double number) { return std::isfinite(number) ? fmt::format("{:.3g}", number) : "-"; }

std::string duration_text(double seconds) {
  const auto whole = std::llround(seconds);
  if (whole < 90) return fmt::format("{} s", whole);
  const auto minutes = std::llround(seconds / 60);
  if (minutes < 60) return fmt::format("{} min", minutes);
  if (minutes < 24LL * 60) return fmt::format("{} h {} min", minutes / 60, minutes % 60);
  const auto hours = std::llround(seconds / seconds_per_hour);
  return fmt::format("{} d {} h", hours / 24, hours % 24);
}

std::string utc_now() { return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))); }

std::int64_t seconds_of_utc(const std::string& time) {
  std::tm parts{};
  const char* const end = strptime(time.c_str(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return end != nullptr && *end == '\0' ? std::int64_t{timegm(&parts)} : 0;
}

}  // namespace peclet::runner
