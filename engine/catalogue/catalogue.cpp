#include "engine/catalogue/catalogue.h"

namespace peclet::engine {
namespace {

// Calls `visit` with each kind of observable that the scene asks for.
template <class Visit>
void for_each_kind(const Scene& scene, const Visit& visit) {
  for (const ObservableKind& kind : observable_kinds()) {
    if (scene.observables.contains(kind.name)) visit(kind);
  }
}

}  // namespace

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
