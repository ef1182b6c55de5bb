#include "runner/text/utc_time.h"

#include <fmt/chrono.h>

#include <ctime>

namespace peclet::runner {

std::string utc_now() { return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))); }

std::int64_t seconds_of_utc(const std::string& time) {
  std::tm parts{};
  const char* const end = strptime(time.c_str(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return end != nullptr && *end == '\0' ? std::int64_t{timegm(&parts)} : 0;
}

}  // namespace peclet::runner
