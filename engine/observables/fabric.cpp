#include "engine/observables/fabric.h"

#include <algorithm>

#include "engine/observables/observable.h"
#include "engine/observables/structure.h"

namespace peclet::engine {
namespace {

void add_pairs(BlockedMean& mean, std::size_t block, const FabricSums::Pairs& pairs) {
  std::size_t component = 0;
  for (const double value : components_of(pairs.sum)) mean.add(block, component++, value);
  mean.weigh(block, pairs.count);
}

class Fabric : public Observable {
 public:
  Fabric(const Plan& plan, double gap)
      : Observable(plan),
        gap_(gap),
        contacts_(mean_if(plan.scene.physics.contact.has_value(), fabric_quantity("fabric/contacts"))),
        near_(mean(fabric_quantity("fabric/near"))) {}

  void sample(const System& system, std::size_t block) override {
    const FabricSums sums = fabric_of(system, gap_);
    add_pairs(contacts_, block, sums.contacts);
    add_pairs(near_, block, sums.near);
  }

 private:
  double gap_;
  BlockedMean &contacts_, &near_;
};

}  // namespace

FabricSums fabric_of(const System& system, double gap) {
  const std::vector<double>& radius = system.particles.radius;
  FabricSums sums;
  const double range = (2 + gap) * *std::ranges::max_element(radius);
  for_each_near_pair(system, range, [&](std::uint32_t i, std::uint32_t j, const Vector3& r) {
    const double touching = radius[i] + radius[j], squared = dot(r, r);
    const auto is_within = [&](double distance) { return squared < distance * distance; };
    if (j < i || !is_within((1 + 0.5 * gap) * touching)) return;  // j < i: counted from j
    const FabricSums::Pairs pair{(1 / squared) * symmetric_dyad(r, r), 1};
    sums.near += pair;
    if (is_within(touching)) sums.contacts += pair;
  });
  return sums;
}

Quantity fabric_quantity(const std::string& name, const std::vector<Axis>& further) {
  Quantity quantity{.name = name, .symbol = "⟨n n⟩", .unit = "1", .axes = {axis_of_components()}};
  quantity.axes.insert(quantity.axes.end(), further.begin(), further.end());
  return quantity;
}

ObservableKind fabric() {
  return {.name = "fabric",
          .meaning = "the fabric tensor <n n> of contacts and of near pairs",
          .settings =
              "/fabric/gap | number > 0 and <= 1; default 0.05 | "
              "Gap xi = 2 (r - a_i - a_j) / (a_i + a_j) below which a pair is near.",
          .read = [](const SceneDocument& document, const Scene&) {
            return maker<Fabric>(document.number("/fabric/gap"));
          }};
}

}  // namespace peclet::engine
