// The assembly of links leaves the loads of an evaluation, which reference_forces_test.cpp tests.
#include <gtest/gtest.h>

#include <limits>

#include "tests/engine/kernels/linked_suspension.h"

namespace peclet::engine {
namespace {

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
