#include <gtest/gtest.h>

#include <algorithm>

#include "engine/integrators/stability.h"
#include "engine/kernels/pair_recipes.h"
#include "engine/realisation/packing.h"
#include "tests/engine/few_spheres.h"
#include "tests/engine/realisation/small_result.h"

namespace peclet::engine {
namespace {

// Returns a packing with repulsion much stronger than the flow. Without relaxation four of seeds 0 to 7 leap
// over their neighbours in the second step.
Scene repulsive_scene() {
  return read_scene(Json::parse(R"({
    "particles": {"count": 100, "density": 0.1,
                  "species": [{"radius": 1, "volume_share": 0.5}, {"radius": 1.4, "volume_share": 0.5}]},
    "volume_fraction": 0.5,
    "fluid": {"viscosity": 0.1},
    "flow": {"shear_rate": 0.045},
    "contact": {"normal_stiffness": 1e4},
    "lubrication": {"form": "kim-karrila"},
    "repulsion": {"form": "exponential", "strength": 1, "relative_length": 0.01, "cutoff_lengths": 5},
    "duration": {"equilibration": {"strain": 0}, "production": {"strain": 0.75}}})"),
                    "scene.json");
}

System packed(const Scene& scene) {
  const std::vector<double> radius = species_radii(scene.particles);
  const double edge = cube_edge(radius, scene.volume_fraction);
  System system = spheres_in({edge, edge, edge}, scene.physics, radius, scene.particles.density);
  system.springs = SpringField(spring_kinds(required_terms(scene.physics)), 0);
  place_randomly(system.particles, system.box, 1);
  return system;
}

TEST(Relaxation, MovesSpheresAndNothingElse) {
  const Scene scene = repulsive_scene();
  System system = packed(scene);
  const System before = system;
  relax(system, scene, 1);
  EXPECT_FALSE(system.particles.position == before.particles.position);
  EXPECT_EQ(system.step, 0u);
  EXPECT_EQ(system.box.strain(), 0);
  EXPECT_EQ(system.box.velocity_gradient(), simple_shear(scene.physics.flow.rate()));
  std::vector<std::uint32_t> id = system.particles.id;
  std::sort(id.begin(), id.end());
  for (std::uint32_t i = 0; i < id.size(); ++i) EXPECT_EQ(id[i], i);
}

// Flow and noise exert no force here.
TEST(Relaxation, LeavesAPackingWithoutForcesWhereItIs) {
  Scene scene = repulsive_scene();
  scene.physics.repulsion.reset();
  scene.physics.thermal_energy = 0.02;
  System system = packed(scene);
  std::vector<Vector3> before(system.particles.count());
  for (std::size_t i = 0; i < before.size(); ++i) {
    before[system.particles.id[i]] = system.particles.position[i];
  }
  relax(system, scene, 1);
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Vector3 r = system.particles.position[i] + system.box.displacement(system.particles.image[i]) -
                      before[system.particles.id[i]];
    EXPECT_NEAR(norm(r), 0, 1e-12);
  }
}

TEST(Relaxation, LetsStronglyRepulsivePackingsStart) {
  const Scene scene = repulsive_scene();
  for (const std::uint64_t seed : {0U, 1U, 2U, 3U, 4U, 5U, 6U, 7U}) {
    Simulation simulation(scene, {automatic_timestep(scene).value, 0, 40}, seed, 1, "scene.json");
    simulation.start();
    const std::optional<Ending> ending = simulation.advance(40);
    ASSERT_TRUE(ending.has_value());
    EXPECT_EQ(ending->cause, Ending::Cause::completed) << ending->message;
  }
}

}  // namespace
}  // namespace peclet::engine
