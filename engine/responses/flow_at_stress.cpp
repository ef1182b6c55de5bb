#include "engine/responses/flow_at_stress.h"

#include <numeric>

namespace peclet::engine {
namespace {

std::vector<Quantity> flow_quantities(const Scene&, const Window&) {
  const auto ratio = [](const char* name, const char* symbol) {
    return Quantity{.name = name, .symbol = symbol, .unit = "1", .ratio = {{"stress", "viscous_stress"}}};
  };
  return {{.name = "shear_rate", .symbol = "<rate>", .unit = "1 / time"},
          {.name = "flowing", .symbol = "P(flows)", .unit = "1"},
          ratio("apparent_viscosity", "eta_r"),
          ratio("viscosity_of_those_flowing", "eta_r^flowing")};
}

}  // namespace

FlowAtStress::FlowAtStress(const Scene& scene, const Window& window)
    : Observable(1),
      stress_(*scene.physics.flow.deformation().stress()),
      viscosity_(scene.physics.viscosity),
      steps_(window.steps) {}

// The rate of a step, which is constant in it.
void FlowAtStress::sample(const System& system, std::size_t block) {
  rates_[block] += system.box.velocity_gradient().column[1].x;
  ++taken_;
}

void FlowAtStress::add_to(Json& mean) const {
  const double rate = std::accumulate(rates_.begin(), rates_.end(), 0.0) / static_cast<double>(steps_);
  const double flows = taken_ == steps_ ? 1 : 0;
  mean["shear_rate"] = rate;
  mean["flowing"] = flows;
  mean["apparent_viscosity"] = {{"stress", stress_}, {"viscous_stress", viscosity_ * rate}};
  mean["viscosity_of_those_flowing"] = {{"stress", flows * stress_},
                                        {"viscous_stress", flows * viscosity_ * rate}};
}

void FlowAtStress::add_blocks_to(Json& blocks) const {
  Json& rates = blocks["shear_rate"] = Json::array();
  for (std::size_t block = 0; block < count_of_blocks; ++block) {
    const auto begin = [&](std::size_t b) { return (b * steps_ + count_of_blocks - 1) / count_of_blocks; };
    rates.push_back(rounded(rates_[block] / static_cast<double>(begin(block + 1) - begin(block))));
  }
}

void FlowAtStress::save(ArchiveWriter& archive) const {
  archive.put(taken_);
  archive.put(rates_);
}

void FlowAtStress::load(ArchiveReader& archive) {
  taken_ = archive.get<std::uint64_t>();
  rates_ = archive.get<std::array<double, count_of_blocks>>();
}

ObservableKind flow_at_stress() {
  return {"flow_at_stress", every_step, [](const Scene&, const Window&, const std::string&) {},
          flow_quantities,
          [](const Scene& scene, const System&, const Window& window) -> std::unique_ptr<Observable> {
            return std::make_unique<FlowAtStress>(scene, window);
          }};
}

}  // namespace peclet::engine
