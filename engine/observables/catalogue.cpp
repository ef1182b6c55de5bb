#include "engine/observables/catalogue.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "contract/input_error.h"

namespace peclet::engine {
namespace {

// What changes slowly is sampled this often.
constexpr std::uint64_t samples_of_structure = 256;

// Calls `visit` with each kind of observable that the scene asks for.
template <class Visit>
void for_each_kind(const Scene& scene, const Visit& visit) {
  for (const ObservableKind& kind : observable_kinds()) {
    if (scene.observables.contains(kind.name)) visit(kind);
  }
}

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

void check_observables(const Scene& scene, const Window& window, const std::string& file) {
  for_each_kind(scene, [&](const ObservableKind& kind) { kind.check(scene, window, file); });
}

std::vector<Quantity> observed_quantities(const Scene& scene, const Window& window) {
  std::vector<Quantity> quantities;
  for_each_kind(scene, [&](const ObservableKind& kind) {
    for (Quantity& quantity : kind.quantities(scene, window)) quantities.push_back(std::move(quantity));
  });
  return quantities;
}

std::vector<std::unique_ptr<Observable>> make_observables(const Scene& scene, const System& system,
                                                          const Window& window) {
  std::vector<std::unique_ptr<Observable>> made;
  for_each_kind(scene, [&](const ObservableKind& kind) { made.push_back(kind.make(scene, system, window)); });
  return made;
}

}  // namespace peclet::engine
