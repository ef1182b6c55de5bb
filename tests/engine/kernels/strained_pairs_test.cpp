// Lubrication relative to the flow in the pair loop: instruction sets, threads, and one flow given twice.
#include <gtest/gtest.h>

#include <memory>

#include "engine/flow/waves.h"
#include "engine/realisation/packing.h"
#include "tests/engine/available_sets.h"
#include "tests/engine/dense_suspension.h"
#include "tests/engine/draws.h"
#include "tests/engine/pair_evaluation.h"

namespace peclet::engine {
namespace {

Physics wavy(Physics physics) {
  physics.flow =
      ImposedFlow(std::make_shared<SteadyShear>(physics.flow.rate()),
                  std::make_shared<Waves>(std::vector<Wave>{{1, 0.8, 0.2}, {2, -0.3, 0.1}}, /*faxen=*/true));
  return physics;
}

// Flow with waves; other tests cover uniform flow.
TEST(StrainedPairs, EqualTheirSingleTwinOnEveryInstructionSetForEveryRecipe) {
  for (const InstructionSet set : available_sets()) {
    for (const Terms& terms : every_recipe()) {
      if (!terms.strained) continue;
      const Physics physics = wavy(physics_with(terms));
      const System system = dense_suspension(physics, 200, 12);
      expect_near(evaluated(physics, system, 1, InstructionSet::baseline), evaluated(physics, system, 1, set),
                  text(terms) + name_of(set));
    }
  }
}

TEST(StrainedPairs, HaveTheSameBitsOnAnyNumberOfThreads) {
  const Physics physics = wavy(physics_with(
      {.lubrication = true, .noise = true, .strained = true, .contact = true, .friction = true}));
  System system = dense_suspension(physics, 8500, 8);
  rebuild_neighbours(system);
  ASSERT_EQ(system.list.blocks().size(), 4u);
  const Evaluation one = evaluated(physics, system, 1);
  for (const int threads : {2, 3}) {
    const Evaluation many = evaluated(physics, system, threads);
    expect_same_bits(one, many, std::to_string(threads) + " threads");
  }
}

// u' = G x is not periodic, so spheres lie away from the faces of the cell.
class LinearVariation final : public FlowVariation {
 public:
  explicit LinearVariation(const Matrix3& gradient) : gradient_(gradient) {}
  Local at(const Vector3& x, const PeriodicCell& /*cell*/) const override {
    return {gradient_ * x, {}, gradient_, {}};
  }
  double largest_rate(const PeriodicCell& /*cell*/) const override { return norm(gradient_); }

 private:
  Matrix3 gradient_;
};

// Returns spheres at random places in the middle of a much larger cell.
System cluster(const Physics& physics) {
  Draws draws(5);
  std::vector<double> radius(90, 1.0);
  radius.resize(120, 3.0);
  const double inner = cube_edge(radius, 0.5), edge = 3 * inner;
  System system;
  ParticleState& particles = system.particles = make_particles(radius, 0.1);
  place_randomly(particles, PeriodicCell({inner, inner, inner}, Matrix3{}), 5);
  for (std::size_t i = 0; i < particles.count(); ++i) {
    particles.position.add(i, Vector3{inner, inner, inner} + draws.vector(0.02));
    particles.velocity.set(i, draws.vector());
    particles.angular_velocity.set(i, draws.vector());
  }
  system.box = PeriodicCell({edge, edge, edge}, physics.flow.deformation().velocity_gradient(0));
  system.list = NeighbourList(range_table(make_pair_kinds(physics, {1, 3}), 2), 0.05);
  rebuild_neighbours(system);
  return system;
}

TEST(StrainedPairs, FeelAShearThatVariesNotAtAllAsAUniformOne) {
  const Physics uniform = physics_with({.lubrication = true, .strained = true});
  Physics varying = uniform;
  varying.flow = ImposedFlow(std::make_shared<SteadyShear>(0),
                             std::make_shared<LinearVariation>(simple_shear(uniform.flow.rate())));
  System system = cluster(uniform);
  const Evaluation one = evaluated(uniform, system, 1);
  // The cell is at rest, so the shear moves no images.
  system.box = PeriodicCell(system.box.lengths(), Matrix3{});
  const Evaluation other = evaluated(varying, system, 1);
  EXPECT_GT(norm(one.force[0]) + norm(one.force[1]), 0);
  expect_near(components(one.force), components(other.force), "force", 1e-11);
  expect_near(components(one.torque), components(other.torque), "torque", 1e-11);
  expect_near(components(one.sums), components(other.sums), "stress", 1e-11);
}

}  // namespace
}  // namespace peclet::engine
