#include "engine/observables/observable.h"

#include <fmt/format.h>

#include "contract/errors.h"

namespace peclet::engine {

const std::vector<ObservableKind>& observable_kinds() {
  static const std::vector<ObservableKind> all{mean_squared_displacement(),
                                               stress_correlation(),
                                               pair_distribution(),
                                               contact_network(),
                                               fabric(),
                                               profiles(),
                                               linear_response(),
                                               oscillation(),
                                               transient(),
                                               trajectory(),
                                               measure()};
  return all;
}

std::vector<std::unique_ptr<Observable>> make_observables(const Scene& scene, const Window& window,
                                                          const std::string& file) {
  std::vector<std::unique_ptr<Observable>> made;
  for (const auto& [name, make] : scene.observables) made.push_back(make(scene, window, file));
  return made;
}

void Plan::need_samples(const char* name, std::uint64_t least) const {
  if (samples() >= least) return;
  throw InputError(file, fmt::format("/{}/interval", name), fmt::format("{} samples", samples()),
                   fmt::format("must leave at least {} samples in the production window of {} steps", least,
                               window.steps));
}

void require_rest(const SceneDocument& document, const Scene& scene, const char* name) {
  const bool rests = scene.physics.flow.rate() == 0 && !scene.physics.flow.varies();
  if (rests && scene.physics.thermal_energy > 0) return;
  document.refuse("/observables", "must not list {} unless the thermal energy is > 0 and the fluid at rest",
                  name);
}

void require_stress_of_forces(const SceneDocument& document, const Scene& scene, const char* name) {
  const auto& lubrication = scene.physics.lubrication;
  if (!lubrication || lubrication->form != LubricationParameters::Form::mari) return;
  document.refuse("/observables",
                  "must not list {} with /lubrication/form mari: its stress is not that of the forces alone",
                  name);
}

std::vector<double> radii_in(const Scene& scene) {
  std::vector<double> radii;
  for (const Species& species : scene.particles.species) radii.push_back(species.radius);
  return distinct_radii(radii);
}

std::vector<PairKind> pair_kinds_in(const Scene& scene) {
  return make_pair_kinds(scene.physics, radii_in(scene));
}

}  // namespace peclet::engine
