#include "engine/realisation/ending.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace peclet::engine {

const char* name_of(Ending::Cause cause) {
  switch (cause) {
    case Ending::Cause::completed:
      return "completed";
    case Ending::Cause::jammed:
      return "jammed";
    case Ending::Cause::overlap:
      return "overlap";
    case Ending::Cause::displacement:
      return "displacement";
    case Ending::Cause::non_finite:
      return "non-finite";
    case Ending::Cause::packing:
      return "packing";
    case Ending::Cause::timestep:
      return "timestep";
  }
  return "";
}

std::optional<Ending> ending_of(const StepReport& report, const System& system, const Guard& guard,
                                double smallest_radius) {
  const double displacement = report.largest_displacement / smallest_radius;
  if (!std::isfinite(displacement) || !report.sums.finite) {
    return Ending{Ending::Cause::non_finite, system.step, "a position or velocity is not finite"};
  }
  // Whatever the guard, spheres must not leap over each other: the integrator evaluates no forces then.
  const double largest =
      std::min(guard.largest_displacement, 0.5 * system.list.ranges().largest() / smallest_radius);
  if (displacement > largest) {
    const std::string part =
        report.division == 0 ? "one step" : fmt::format("1/{} of a step", 1 << report.division);
    return Ending{
        Ending::Cause::displacement, system.step,
        fmt::format("a particle moved {:.3g} radii in {}, more than {:.3g}", displacement, part, largest)};
  }
  if (report.sums.largest_overlap > guard.largest_overlap) {
    return Ending{Ending::Cause::overlap, system.step,
                  fmt::format("two particles overlap by {:.3g} radii, more than {:.3g}: jammed, or too soft",
                              report.sums.largest_overlap, guard.largest_overlap)};
  }
  return std::nullopt;
}

}  // namespace peclet::engine
