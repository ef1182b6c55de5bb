// Spheres of any mass, carried by the fluid through the deforming cell, by explicit and implicit steps.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/flow/controlled_shear.h"
#include "engine/flow/extension.h"
#include "engine/flow/segments.h"
#include "engine/flow/shear.h"
#include "tests/engine/few_spheres.h"

namespace peclet::engine {
namespace {

using Flow = std::shared_ptr<const Deformation>;

Flow oscillation() { return std::make_shared<OscillatoryShear>(0.3, 2); }
Flow extension() { return std::make_shared<PlanarExtension>(0.5); }

constexpr Vector3 places_at_start[] = {{3, 5, 7}, {12, 15, 18}};

System carried(const Flow& deformation, bool implicit, int steps, double step, double density = 1e-6) {
  Physics physics;
  physics.viscosity = 1;
  physics.flow = ImposedFlow(deformation);
  physics.contact = ContactParameters{.normal_stiffness = 1};  // gives the list a range
  System system = spheres_in({40, 40, 40}, physics, {1, 1}, density);
  for (const std::size_t i : {0U, 1U}) {
    system.particles.position.set(i, places_at_start[i]);
    system.particles.velocity.set(i, system.box.velocity_gradient() * places_at_start[i]);
    system.particles.angular_velocity.set(i, spin_of(system.box.velocity_gradient()));
  }
  start_and_advance(*steps_of_method(implicit, physics, system, step, 1e-6), system, steps);
  return system;
}

// Returns the distance of a sphere from the place to which the fluid has carried it.
double distance_from_fluid(const System& system, std::size_t i, const Matrix3& made) {
  const Vector3 unwrapped = system.particles.position[i] + system.box.displacement(system.particles.image[i]);
  return norm(unwrapped - (places_at_start[i] + made * places_at_start[i]));
}

TEST(Deformation, OfAnyKindIsFollowedByBothMethods) {
  struct Case {
    Flow deformation;
    bool implicit;
    int steps;
    double step;
  };
  // Explicit steps must resolve m / zeta = 2/9 1e-6.
  const Case cases[] = {{oscillation(), true, 400, 0.005},
                        {extension(), true, 400, 0.005},
                        {oscillation(), false, 2000, 2e-7},
                        {extension(), false, 2000, 2e-7}};
  for (const Case& each : cases) {
    const System system = carried(each.deformation, each.implicit, each.steps, each.step);
    const double time = each.steps * each.step;
    EXPECT_NEAR(system.clock.time(), time, 1e-12 * time);
    const Matrix3 made = each.deformation->displacement_gradient(time);
    EXPECT_NEAR(norm(system.box.displacement_gradient() - made), 0, 1e-12);
    EXPECT_NEAR(norm(system.box.velocity_gradient() - each.deformation->velocity_gradient(time)), 0, 1e-12);
    // The tolerance is far smaller than the displacement of up to 8: the methods are of second order.
    const double tolerance = each.implicit ? 2e-3 : 1e-6;
    for (std::size_t i = 0; i < 2; ++i) EXPECT_LT(distance_from_fluid(system, i, made), tolerance) << i;
  }
}

// m / zeta = 2/9 at density 1: with drag alone spheres would lag by that time and miss their path by about
// 0.1, more with distance from the origin. Explicit steps follow to first order.
TEST(Deformation, IsFollowedByHeavySpheresWhereverTheyAre) {
  const Flow flows[] = {oscillation(), extension(), std::make_shared<UniaxialExtension>(-0.5),
                        std::make_shared<CrossShear>(0.4, 0.3, 2),
                        std::make_shared<Segments>(std::vector<Segment>{{1, 1, 0.7}, {-1, 0.5, 0.6}}, 0.0)};
  for (const bool implicit : {true, false}) {
    for (const Flow& flow : flows) {
      const double time = 2, step = implicit ? 0.005 : 0.0002;
      const System system =
          carried(flow, implicit, static_cast<int>(std::lround(time / step)), step, /*density=*/1);
      const Matrix3 made = flow->displacement_gradient(time);
      for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_LT(distance_from_fluid(system, i, made), implicit ? 2e-3 : 1e-2) << implicit;
        const Vector3 peculiar =
            system.particles.velocity[i] - system.box.velocity_gradient() * system.particles.position[i];
        EXPECT_LT(norm(peculiar), 1e-3) << implicit;
        EXPECT_LT(norm(system.particles.angular_velocity[i] - spin_of(system.box.velocity_gradient())), 1e-6);
      }
    }
  }
}

// The state stores the deformation of the cell: a restored state continues identically.
TEST(Deformation, IsPartOfTheSavedState) {
  const System system = carried(oscillation(), true, 10, 0.005);
  ArchiveWriter writer;
  save(system, writer);
  System again = carried(oscillation(), true, 0, 0.005);
  ArchiveReader reader(writer.bytes());
  load(again, reader);
  EXPECT_TRUE(reader.at_end());
  EXPECT_EQ(again.clock.time(), system.clock.time());
  EXPECT_EQ(again.box.edges(), system.box.edges());
  EXPECT_EQ(again.box.velocity_gradient(), system.box.velocity_gradient());
}

}  // namespace
}  // namespace peclet::engine
