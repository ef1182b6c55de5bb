#include "runner/text/duration_text.h"

#include <fmt/format.h>

#include <cmath>

namespace peclet::runner {

std::string duration_text(double seconds) {
  const auto whole = std::llround(seconds);
  if (whole < 90) return fmt::format("{} s", whole);
  const auto minutes = std::llround(seconds / 60);
  if (minutes < 60) return fmt::format("{} min", minutes);
  if (minutes < 24LL * 60) return fmt::format("{} h {} min", minutes / 60, minutes % 60);
  const auto hours = std::llround(seconds / seconds_per_hour);
  return fmt::format("{} d {} h", hours / 24, hours % 24);
}

}  // namespace peclet::runner
