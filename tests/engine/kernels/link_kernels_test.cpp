// The matrix of an implicit step is the derivative of the forces that the step balances. Its assembly leaves
// the loads of an evaluation, which reference_forces_test.cpp tests.
#include <gtest/gtest.h>

#include <limits>

#include "tests/engine/few_spheres.h"
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

// Returns two unit spheres at this distance along x, the second of which moves along x.
System pair_along_x(const Physics& physics, double distance, double velocity = 0) {
  System system = spheres_in({20, 20, 20}, physics, {1, 1});
  system.particles.position.set(0, {5, 5, 5});
  system.particles.position.set(1, {5 + distance, 5, 5});
  system.particles.velocity.set(1, {velocity, 0, 0});
  rebuild_neighbours(system);
  return system;
}

// Returns the entry of the matrix for the second sphere's velocity along an axis, without its mass.
double felt_by_second(const Links& links, int axis) {
  std::vector<MotionRow> unit(2);
  const ParticleState& particles = links.system().particles;
  const std::uint32_t second = particles.id[0] == 1 ? 0 : 1;
  unit[second].v[axis] = 1;
  return static_cast<double>(links.times(unit)[second].v[axis]) - particles.mass[0];
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
    const Links links(physics, pair_along_x(physics, 2 + gap, closing), GetParam(), weights,
                      StepResistance::Part::on_the_way);
    const double found = felt_by_second(links, 0);
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
  System system = pair_along_x(physics, 1.99);
  const double per_load = contact.normal_stiffness * 0.01 / contact.tangential_stiffness;
  const double length = 0.4 * per_load;  // between 0.3 and 0.5
  for (const double slides : {0.0, 1.0}) {
    system.springs = SpringField(SpringKinds::tangential_that_slide, 1);
    system.springs.set(0, {{0, length, 0}, {}, slides});
    LinkWeights of_links = weights;
    of_links.normal_time = 0;
    const Links links(physics, system, GetParam(), of_links);
    const double found = felt_by_second(links, 1);
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
  for (MotionRow& row : same) row.v = Floats{1, -2, 0.5F, 0, 0, 0, 0, 0};
  const auto product = links.times(same);
  for (std::size_t i = 0; i < count; ++i) {
    for (int c = 0; c < 3; ++c) {
      const double mass = links.system().particles.mass[i];
      EXPECT_NEAR(static_cast<double>(product[i].v[c]), mass * static_cast<double>(same[i].v[c]), 1e-4);
      EXPECT_NEAR(static_cast<double>(product[i].v[4 + c]), 0, 1e-4);
    }
  }
}

using Part = StepResistance::Part;

class LinkLoadsOf : public testing::TestWithParam<InstructionSet> {};
INSTANTIATE_TEST_SUITE_P(EverySet, LinkLoadsOf, testing::ValuesIn(available_sets()),
                         [](const auto& set) { return std::string(name_of(set.param)); });

ForceField field_of(const Physics& physics, const System& system, InstructionSet set, Part part) {
  return {physics, system.particles, step, 7, 1, set, 0.5 * step, part};
}

void expect_those_of_an_evaluation(const Terms& terms, std::size_t count, InstructionSet set, Part part) {
  const Physics physics = physics_with(terms);
  System system = dense_suspension(physics, count, 7);
  ForceField field = field_of(physics, system, set, part);
  ASSERT_TRUE(field.leaves_loads_with_links());
  VectorField force(count), torque(count), expected_force(count), expected_torque(count);
  LinkOrder order;
  std::vector<LinkGroup> groups;
  order.arrange(system.list, count);
  const ForceField::LoadRows rows = {force, torque};
  const ForceField::AssembleLinks assemble = field.assemble_links(system, weights, order, groups, &rows);
  for (std::size_t block = 0; block < order.blocks().size(); ++block) assemble(block);
  field.add_incoming(system, force, torque);
  field.evaluate(system, expected_force, expected_torque);
  // A mean over the shortest move, 1e-5 of the inner gap, is a difference of logarithms of gaps, at most 7,
  // over the move. It multiplies rounding by 7e5 in each of two evaluations, for a dozen near spheres.
  constexpr double rounding = 2 * 12 * 7e5 * std::numeric_limits<double>::epsilon();
  double largest_force = 0, largest_torque = 0;
  for (std::size_t i = 0; i < count; ++i) {
    largest_force = std::max(largest_force, norm(expected_force[i]));
    largest_torque = std::max(largest_torque, norm(expected_torque[i]));
  }
  for (std::size_t i = 0; i < count; ++i) {
    ASSERT_LE(norm(force[i] - expected_force[i]), rounding * largest_force) << text(terms) << ' ' << i;
    ASSERT_LE(norm(torque[i] - expected_torque[i]), rounding * largest_torque) << text(terms) << ' ' << i;
  }
}

TEST_P(LinkLoadsOf, AreThoseOfAnEvaluation) {
  for (const Terms& terms : {Terms{.lubrication = true}, Terms{.contact = true}, Terms{.conservative = true},
                             Terms{.lubrication = true, .contact = true, .conservative = true}}) {
    for (const Part part : {Part::whole, Part::at_beginning, Part::ahead}) {
      expect_those_of_an_evaluation(terms, 203, GetParam(), part);
    }
  }
}

// Includes pairs on both sides of a border between blocks.
TEST_P(LinkLoadsOf, AreThoseOfAnEvaluationInSeveralBlocks) {
  expect_those_of_an_evaluation({.lubrication = true, .contact = true}, 4500, GetParam(), Part::ahead);
}

TEST_P(LinkLoadsOf, AreNotLeftWhereAnEvaluationDoesMore) {
  for (const Terms& terms :
       {Terms{.contact = true, .friction = true}, Terms{.contact = true, .damping = true},
        Terms{.lubrication = true, .strained = true}, Terms{.lubrication = true, .noise = true}}) {
    const Physics physics = physics_with(terms);
    const System system = dense_suspension(physics, 30, 7);
    EXPECT_FALSE(field_of(physics, system, GetParam(), Part::whole).leaves_loads_with_links()) << text(terms);
  }
  // The matrix has the derivative of a mean resistance; the forces have the mean.
  const Physics physics = physics_with({.lubrication = true});
  const System system = dense_suspension(physics, 30, 7);
  EXPECT_FALSE(field_of(physics, system, GetParam(), Part::on_the_way).leaves_loads_with_links());
}

}  // namespace
}  // namespace peclet::engine
