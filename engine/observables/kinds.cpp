#include "engine/observables/kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "contract/input_error.h"

namespace peclet::engine {
namespace {

// What changes slowly is sampled this often.
constexpr std::uint64_t samples_of_structure = 256;

}  // namespace

std::uint64_t every_step(const Window&) { return 1; }

std::uint64_t seldom(const Window& window) { return window.steps / samples_of_structure; }

std::uint64_t interval_of(const Scene& scene, const ObservableKind& kind, const Window& window) {
  const Json& settings = scene.observables.at(kind.name);
  if (!settings.contains("interval")) return std::max<std::uint64_t>(1, kind.usual_interval(window));
  // Longer than any window is never again.
  const double steps = std::round(settings.at("interval").get<double>() / window.timestep);
  return static_cast<std::uint64_t>(std::clamp(steps, 1.0, 1e18));
}

std::vector<double> radii_in(const Scene& scene) {
  std::vector<double> radii;
  for (const Species& species : scene.particles.species) radii.push_back(species.radius);
  return distinct_radii(radii);
}

void need_samples(const Scene& scene, const ObservableKind& kind, const Window& window, std::uint64_t least,
                  const std::string& file) {
  const std::uint64_t samples = samples_in(window.steps, interval_of(scene, kind, window));
  if (samples >= least) return;
  throw InputError(file, fmt::format("/{}/interval", kind.name), fmt::format("{} samples", samples),
                   fmt::format("must leave at least {} samples in the production window of {} steps", least,
                               window.steps));
}

}  // namespace peclet::engine
