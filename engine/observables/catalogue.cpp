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
  // Longer than any window is never again.
  return static_cast<std::uint64_t>(std::clamp(std::round(*interval / timestep), 1.0, 1e18));
}

void need_samples(std::uint64_t steps, std::uint64_t interval, std::uint64_t least, const char* name,
                  const std::string& file) {
  const std::uint64_t samples = samples_in(steps, interval);
  if (samples >= least) return;
  throw InputError(
      file, fmt::format("/{}/interval", name), fmt::format("{} samples", samples),
      fmt::format("must leave at least {} samples in the production window of {} steps", least, steps));
}

// Steps between the samples of every observable that there is.
struct Intervals {
  std::uint64_t mean_squared_displacement, stress_correlation, pair_distribution, contact_network;
};

Intervals intervals_of(const Scene& scene, double timestep, std::uint64_t steps) {
  const auto of = [&](const auto& settings, std::uint64_t otherwise) {
    return settings ? steps_in(settings->interval, timestep, otherwise) : 0;
  };
  const std::uint64_t seldom = steps / samples_of_structure;
  return {of(scene.mean_squared_displacement, 1), of(scene.stress_correlation, 1),
          of(scene.pair_distribution, seldom), of(scene.contact_network, seldom)};
}

}  // namespace

void check_observables(const Scene& scene, double edge, double timestep, std::uint64_t steps,
                       const std::string& file) {
  const Intervals intervals = intervals_of(scene, timestep, steps);
  if (scene.mean_squared_displacement) {
    need_samples(steps, intervals.mean_squared_displacement, 8, "mean_squared_displacement", file);
  }
  if (scene.stress_correlation)
    need_samples(steps, intervals.stress_correlation, 16, "stress_correlation", file);
  if (scene.pair_distribution) check_pair_distribution(scene, edge, file);
}

std::vector<std::string> names_of_numbers(const Scene& scene) {
  std::vector<std::string> names;
  if (scene.mean_squared_displacement && scene.physics.thermal_energy > 0)
    names.emplace_back("self_diffusion");
  if (scene.stress_correlation) names.emplace_back("green_kubo_viscosity");
  if (scene.contact_network && scene.physics.contact->friction > 0) {
    names.emplace_back("mobilised_friction");
    names.emplace_back("sliding_contacts");
  }
  return names;
}

std::vector<std::unique_ptr<Observable>> make_observables(const Scene& scene, const System& system,
                                                          double timestep, std::uint64_t steps) {
  const Intervals intervals = intervals_of(scene, timestep, steps);
  std::vector<std::unique_ptr<Observable>> made;
  if (scene.mean_squared_displacement) {
    made.push_back(std::make_unique<MeanSquaredDisplacement>(scene, system, timestep,
                                                             intervals.mean_squared_displacement, steps));
  }
  if (scene.stress_correlation) {
    made.push_back(
        std::make_unique<StressCorrelation>(scene, system, timestep, intervals.stress_correlation, steps));
  }
  if (scene.pair_distribution) {
    made.push_back(std::make_unique<PairDistribution>(scene, system, intervals.pair_distribution));
  }
  if (scene.contact_network) {
    made.push_back(std::make_unique<ContactNetwork>(scene, system, intervals.contact_network));
  }
  return made;
}

}  // namespace peclet::engine
