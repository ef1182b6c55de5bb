#include "engine/observables/contact_network.h"

#include <algorithm>

#include "engine/kernels/pairs/pair_access.h"

namespace peclet::engine {
namespace {

// A spring that is cut at each step is as long as it may be but for what the step itself changes.
constexpr double sliding_from = 0.99;

template <std::size_t size>
Json shares(const std::array<std::uint64_t, size>& counts, std::uint64_t all) {
  if (all == 0) return nullptr;
  Json list = Json::array();
  for (const std::uint64_t count : counts) {
    list.push_back(static_cast<double>(count) / static_cast<double>(all));
  }
  return list;
}

}  // namespace

ContactNetwork::ContactNetwork(const Scene& scene, const System& system, const Window& window)
    : Observable(interval_of(scene, contact_network(), window)),
      contact_(*scene.physics.contact),
      kinds_(make_pair_kinds(scene.physics, distinct_radii(system.particles.radius))) {}

void ContactNetwork::sample(const System& system) {
  const std::vector<ImageFrame> frames = image_frames(system.list, system.box);
  const std::vector<Pair>& pairs = system.list.pairs();
  std::vector<std::size_t> touching(system.particles.count());
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const Pair& pair = pairs[p];
    const double distance = norm(separation(system.particles, pair, frames[pair.image]));
    const double overlap = kinds_[pair.kind].sum_of_radii - distance;
    if (!(overlap > 0)) continue;
    ++touching[pair.first];
    ++touching[pair.second];
    ++sums_.contacts;
    if (!(contact_.friction > 0)) continue;
    const double mobilised = contact_.tangential_stiffness * norm(system.springs[p].tangential) /
                             (contact_.friction * contact_.normal_stiffness * overlap);
    sums_.mobilised += mobilised;
    sums_.sliding += mobilised > sliding_from ? 1 : 0;
    const auto twentieth = static_cast<std::size_t>(20 * std::min(mobilised, 1.0));
    ++sums_.by_mobilisation[std::min<std::size_t>(twentieth, 19)];
  }
  for (const std::size_t contacts : touching) ++sums_.by_contacts[std::min<std::size_t>(contacts, 12)];
  sums_.particles += system.particles.count();
}

void ContactNetwork::add_to(Json& mean) const {
  const auto contacts = static_cast<double>(sums_.contacts);
  mean["contact_network"]["contacts"] = shares(sums_.by_contacts, sums_.particles);
  if (!(contact_.friction > 0)) return;
  const bool any = sums_.contacts > 0;
  mean["contact_network"]["mobilisation"] = shares(sums_.by_mobilisation, sums_.contacts);
  mean["mobilised_friction"] = any ? Json(sums_.mobilised / contacts) : Json();
  mean["sliding_contacts"] = any ? Json(static_cast<double>(sums_.sliding) / contacts) : Json();
}

ObservableKind contact_network() {
  return {"contact_network", seldom, [](const Scene&, const Window&, const std::string&) {},
          [](const Scene& scene) {
            return scene.physics.contact->friction > 0
                       ? std::vector<std::string>{"mobilised_friction", "sliding_contacts"}
                       : std::vector<std::string>{};
          },
          [](const Scene& scene, const System& system, const Window& window) -> std::unique_ptr<Observable> {
            return std::make_unique<ContactNetwork>(scene, system, window);
          }};
}

}  // namespace peclet::engine
