#include "engine/observables/catalogue.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "contract/input_error.h"
#include "engine/observables/contact_network.h"
#include "engine/observables/mean_squared_displacement.h"
#include "engine/observables/pair_distribution.h"
#include "engine/observables/stress_correlation.h"

namespace peclet::engine {
namespace {

// What changes slowly and costs a walk over all pairs is sampled this often unless the scene says otherwise.
constexpr std::uint64_t samples_of_structure = 256;

// Whole steps, one at least.
std::uint64_t steps_in(const std::optional<double>& interval, double timestep, std::uint64_t otherwise) {
  if (!interval) return std::max<std::uint64_t>(1, otherwise);
  return static_cast<std::uint64_t>(std::max(1.0, std::round(*interval / timestep)));
}

void need_samples(std::uint64_t steps, std::uint64_t interval, std::uint64_t least, const char* name,
                  const std::string& file) {
  const std::uint64_t samples = samples_in(steps, interval);
  if (samples >= least) return;
  throw InputError(
      file, fmt::format("/{}/interval", name), fmt::format("{} samples", samples),
      fmt::format("must leave at least {} samples in the production window of {} steps", least, steps));
}

}  // namespace

std::vector<std::unique_ptr<Observable>> make_observables(const Scene& scene, const System& system,
                                                          double timestep, std::uint64_t steps,
                                                          const std::string& file) {
  std::vector<std::unique_ptr<Observable>> made;
  if (scene.mean_squared_displacement) {
    const std::uint64_t interval = steps_in(scene.mean_squared_displacement->interval, timestep, 1);
    need_samples(steps, interval, 8, "mean_squared_displacement", file);
    made.push_back(std::make_unique<MeanSquaredDisplacement>(scene, system, timestep, interval, steps));
  }
  if (scene.stress_correlation) {
    const std::uint64_t interval = steps_in(scene.stress_correlation->interval, timestep, 1);
    need_samples(steps, interval, 16, "stress_correlation", file);
    made.push_back(std::make_unique<StressCorrelation>(scene, system, timestep, interval, steps));
  }
  const std::uint64_t seldom = steps / samples_of_structure;
  if (scene.pair_distribution) {
    const std::uint64_t interval = steps_in(scene.pair_distribution->interval, timestep, seldom);
    made.push_back(std::make_unique<PairDistribution>(scene, system, interval, file));
  }
  if (scene.contact_network) {
    const std::uint64_t interval = steps_in(scene.contact_network->interval, timestep, seldom);
    made.push_back(std::make_unique<ContactNetwork>(scene, system, interval));
  }
  return made;
}

}  // namespace peclet::engine
