// Restoring the beginning of a step, across steps that rebuild the neighbour list.
#include <gtest/gtest.h>

#include "tests/engine/dense_suspension.h"
#include "tests/engine/few_spheres.h"

namespace peclet::engine {
namespace {

struct Case {
  const char* name;
  bool is_implicit;
  double thermal_energy;
};
constexpr Case cases[] = {
    {"explicit_steps", false, 0.02}, {"implicit_steps", true, 0}, {"noisy", true, 0.02}};

class Marked : public testing::TestWithParam<Case> {
 protected:
  static std::string bytes_of(const System& system, const Integrator& integrator) {
    ArchiveWriter archive;
    save(system, archive);
    integrator.save(archive);
    return archive.bytes();
  }
};
INSTANTIATE_TEST_SUITE_P(OfEachMethod, Marked, testing::ValuesIn(cases),
                         [](const auto& each) { return std::string(each.param.name); });

// Two marks in a row: the second finds the list of the first, or another list.
TEST_P(Marked, StateIsTheSameAfterTheWayBackAndSoAreStepsFromThere) {
  const auto [name, is_implicit, thermal_energy] = GetParam();
  const bool noise = thermal_energy > 0;
  Physics physics =
      physics_with({.lubrication = true, .noise = noise, .contact = true, .friction = true, .rolling = true});
  physics.thermal_energy = thermal_energy;
  System system = dense_suspension(physics, 200, 7);
  const double timestep = is_implicit ? 0.01 : 1e-4;
  const auto integrator = steps_of_method(is_implicit, physics, system, timestep, 1e-3, /*of_seed=*/5);
  integrator->start(system);
  bool was_rebuilt = false;
  for (int round = 0; round < 4; ++round) {
    integrator->advance(system);
    const std::string before = bytes_of(system, *integrator);
    const std::uint64_t builds = system.list.builds();
    integrator->mark(system);
    std::string after_one;
    for (const int steps : {1, is_implicit ? 20 : 400, 1}) {
      for (int n = 0; n < steps; ++n) integrator->advance(system);
      const std::string after = bytes_of(system, *integrator);
      if (after_one.empty()) after_one = after;
      EXPECT_EQ(after == after_one, steps == 1) << round << ", " << steps << " steps";
      was_rebuilt |= system.list.builds() != builds;
      integrator->return_to_mark(system);
      EXPECT_TRUE(bytes_of(system, *integrator) == before) << round << ", " << steps << " steps";
    }
  }
  EXPECT_TRUE(was_rebuilt);
}

}  // namespace
}  // namespace peclet::engine
