// What bounds a run beside the campaign itself.
#pragma once

#include <map>
#include <optional>
#include <string>

namespace peclet::runner {

struct Bounds {
  std::optional<int> ceiling{};            // only so many seeds of each point
  std::optional<double> budget_seconds{};  // processor time
  std::map<std::string, double> work{};    // of a realisation, in any unit, by the point's hash
};

}  // namespace peclet::runner
