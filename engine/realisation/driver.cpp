#include "engine/realisation/driver.h"

#include <algorithm>

#include "engine/realisation/stress_control.h"

namespace peclet::engine {
namespace {

// Strains are summed over both directions.
class GivenRate final : public Driver {
 public:
  explicit GivenRate(const ImposedFlow& flow) : flow_(flow) {}

  StepReport advance(Integrator& integrator, System& system, PairWatcher* watcher) override {
    integrator.show_pairs_to(watcher);
    return integrator.advance_open(system);
  }
  Strains strains(const System& system, const Schedule& schedule) const override {
    const std::uint64_t begin = std::min(system.step, schedule.equilibration);
    const Deformation& deformation = flow_.deformation();
    return {deformation.strain_between(schedule.timestep, 0, begin),
            deformation.strain_between(schedule.timestep, begin, system.step)};
  }

 private:
  ImposedFlow flow_;
};

}  // namespace

std::unique_ptr<Driver> make_driver(Scene& scene, double timestep, std::uint64_t seed) {
  const ControlledShear* const given = scene.physics.flow.deformation().at_stress();
  if (given == nullptr) return std::make_unique<GivenRate>(scene.physics.flow);
  const auto own = std::make_shared<ControlledShear>(*given);
  scene.physics.flow = ImposedFlow(own);
  return std::make_unique<StressControl>(scene, own, timestep, seed);
}

}  // namespace peclet::engine
