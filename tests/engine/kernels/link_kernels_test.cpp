// The matrix of an implicit step is the derivative of the forces that the step balances.
#include <gtest/gtest.h>

#include "tests/engine/kernels/linked_suspension.h"

namespace peclet::engine {
namespace {

// Returns springs that never slide, whose secant stiffness is the tangent stiffness.
Physics sticking(Physics physics) {
  if (physics.contact && physics.contact->friction > 0) {
    physics.contact->friction = 1e6;
    physics.contact->rolling_friction = 1e6;
  }
  return physics;
}

constexpr Terms tried[] = {
    {.lubrication = true},
    {.contact = true},
    {.lubrication = true, .contact = true, .damping = true},
    {.contact = true, .friction = true},
    {.contact = true, .damping = true, .friction = true},
    {.lubrication = true, .contact = true, .friction = true, .rolling = true},
    {.lubrication = true, .contact = true, .conservative = true},
};

class LinkKernelsOf : public testing::TestWithParam<InstructionSet> {};
INSTANTIATE_TEST_SUITE_P(EverySet, LinkKernelsOf, testing::ValuesIn(available_sets()),
                         [](const auto& set) { return std::string(name_of(set.param)); });

TEST_P(LinkKernelsOf, MultiplyByTheDerivativeOfTheLoads) {
  for (const Terms& terms : tried) {
    const Physics physics = sticking(physics_with(terms));
    // A normal_time > 0 would change the levers of friction as well, which the system leaves out.
    LinkWeights of_links = weights;
    of_links.normal_time = terms.friction ? 0 : weights.normal_time;
    Links links(physics, dense_suspension(physics, 203, 7), GetParam(), of_links);
    const std::size_t count = links.system().particles.count();
    const auto change = random_rows(count, 11);
    // Small enough that no contact opens or closes and the repulsion is linear.
    constexpr double small = 1e-6;
    const std::vector<double> before = links.loads(change, -small), after = links.loads(change, small);
    std::vector<double> expected = numbers(change);
    for (std::size_t k = 0; k < expected.size(); ++k) {
      const ParticleState& particles = links.system().particles;
      expected[k] *= k % 6 < 3 ? particles.mass[k / 6] : particles.inertia[k / 6];
      expected[k] += step * (before[k] - after[k]) / (2 * small);
    }
    expect_near(expected, numbers(links.times(change)), text(terms), 10 * single_precision);
  }
}

// A pair along x in the middle of a step, with the resistance averaged over the gaps of the step. The normal
// force grows with the closing velocity by X_A at the end of the step, or by zero beyond lubrication.
TEST_P(LinkKernelsOf, HaveTheSqueezingResistanceOfTheEndOfTheStep) {
  Physics physics = physics_with({.lubrication = true});
  physics.flow = steady_shear(0);
  const double inner = physics.lubrication->inner_gap, outer = physics.lubrication->outer_gap;
  struct Case {
    double gap, closing;
  };
  for (const auto& [gap, closing] :
       {Case{0.01, -0.1}, Case{0.01, 0.1}, Case{0.5 * inner, -0.1}, Case{0.01, -3},
        Case{0.8 * outer, 60 * outer}, Case{1.2 * outer, -60 * outer}}) {
    System system;
    system.particles = make_particles({1, 1}, 0.1);
    system.box = PeriodicCell({20, 20, 20}, Matrix3{});
    system.list = NeighbourList(range_table(make_pair_kinds(physics, {1.0}), 1), 0.1);
    system.particles.position.set(0, {5, 5, 5});
    system.particles.position.set(1, {7 + gap, 5, 5});
    system.particles.velocity.set(1, {closing, 0, 0});
    rebuild_neighbours(system);
    const Links links(physics, system, GetParam(), weights, StepResistance::Part::on_the_way);
    std::vector<MotionRow> along(2);
    const std::uint32_t second = links.system().particles.id[0] == 1 ? 0 : 1;
    along[second].v[0] = 1;
    const double found = static_cast<double>(links.times(along)[second].v[0]) - system.particles.mass[0];
    const double end = std::max(gap + 0.5 * step * closing, inner);
    // X_A of equal spheres of radius 1.
    const double there =
        6 * std::numbers::pi * physics.viscosity * (0.25 / end + 9.0 / 40 * std::log(1 / end));
    const double expected = end <= outer ? step * there : 0;
    EXPECT_NEAR(found, expected, 1e-5 * step * there) << gap << ' ' << closing;
  }
}

// A pair along x with a spring longer than kinetic and shorter than static friction allows. If it slides, the
// stiffness is the share that leaves it at kinetic friction.
TEST_P(LinkKernelsOf, HaveTheSecantStiffnessOfContactsThatSlide) {
  Physics physics = physics_with({.contact = true, .friction = true, .kinetic = true});
  const ContactParameters& contact = *physics.contact;
  physics.flow = steady_shear(0);
  System system;
  system.particles = make_particles({1, 1}, 0.1);
  system.box = PeriodicCell({20, 20, 20}, Matrix3{});
  system.list = NeighbourList(range_table(make_pair_kinds(physics, {1.0}), 1), 0.1);
  system.particles.position.set(0, {5, 5, 5});
  system.particles.position.set(1, {6.99, 5, 5});
  rebuild_neighbours(system);
  const double per_load = contact.normal_stiffness * 0.01 / contact.tangential_stiffness;
  const double length = 0.4 * per_load;  // between 0.3 and 0.5
  for (const double slides : {0.0, 1.0}) {
    system.springs = SpringField(SpringKinds::tangential_that_slide, 1);
    system.springs.set(0, {{0, length, 0}, {}, slides});
    LinkWeights of_links = weights;
    of_links.normal_time = 0;
    const Links links(physics, system, GetParam(), of_links);
    std::vector<MotionRow> across(2);
    const std::uint32_t second = links.system().particles.id[0] == 1 ? 0 : 1;
    across[second].v[1] = 1;
    const double found = static_cast<double>(links.times(across)[second].v[1]) - system.particles.mass[0];
    const double share = slides == 1 ? 0.3 * per_load / length : 1;
    EXPECT_NEAR(found / (step * step * contact.tangential_stiffness), share, 1e-5) << slides;
  }
}

// Motions that preserve all distances meet inertia and drag alone.
TEST_P(LinkKernelsOf, RigidTranslationFeelsNoLink) {
  const Physics physics = physics_with({.lubrication = true, .contact = true, .friction = true});
  const Links links(physics, dense_suspension(physics, 100, 7), GetParam());
  const std::size_t count = links.system().particles.count();
  std::vector<MotionRow> same(count);
  for (MotionRow& row : same) {
    row.v = Floats{1, -2, 0.5F, 0, 0, 0, 0, 0};
  }
  const auto product = links.times(same);
  for (std::size_t i = 0; i < count; ++i) {
    for (int c = 0; c < 3; ++c) {
      const double mass = links.system().particles.mass[i];
      EXPECT_NEAR(static_cast<double>(product[i].v[c]), mass * static_cast<double>(same[i].v[c]), 1e-4);
      EXPECT_NEAR(static_cast<double>(product[i].v[4 + c]), 0, 1e-4);
    }
  }
}

}  // namespace
}  // namespace peclet::engine
