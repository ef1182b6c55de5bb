// Helps tests of the scheduler with outcomes of known spread.
#pragma once

#include <optional>
#include <stdexcept>
#include <vector>

#include "runner/statistics/scheduler.h"

namespace peclet::runner {

using Outcomes = std::vector<std::vector<std::optional<Outcome>>>;

inline Outcome value(double number) { return {{number, 0}}; }

// Values that are so far apart, or so near, that the stop test at 5 % is certain.
inline Outcome scattered(int seed) { return value(seed % 2 == 0 ? 1 : 19); }
inline Outcome steady_outcome(int seed) { return value(seed % 2 == 0 ? 10 : 10.01); }

inline const Target five_percent{"relative_viscosity", 0.05, 0.95};

// Returns `count` seeds with the values mean - spread and mean + spread in turn.
inline std::vector<std::optional<Outcome>> alternating(int count, double mean, double spread) {
  std::vector<std::optional<Outcome>> outcomes;
  outcomes.reserve(static_cast<std::size_t>(count));
  for (int seed = 0; seed < count; ++seed)
    outcomes.emplace_back(value(seed % 2 == 0 ? mean - spread : mean + spread));
  return outcomes;
}

// Returns a scheduler with stop tests at 4, 5, 7, 9, 12 ... seeds (each the ceiling of 1.25 times the last).
inline Scheduler fresh(int points, int minimum = 4, int maximum = 40) {
  return {Outcomes(static_cast<std::size_t>(points)), five_percent, minimum, maximum};
}

inline SeedId take(Scheduler& scheduler) {
  const std::optional<SeedId> id = scheduler.next();
  if (!id) throw std::logic_error("nothing to run");
  scheduler.begin(*id);
  return *id;
}

}  // namespace peclet::runner
