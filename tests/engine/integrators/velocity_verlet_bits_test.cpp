// Explicit steps agree bit by bit: left open or completed, on any threads, with any instruction set.
#include <gtest/gtest.h>

#include <iostream>

#include "engine/flow/waves.h"
#include "engine/integrators/velocity_verlet.h"
#include "tests/engine/dense_suspension.h"
#include "tests/engine/pair_evaluation.h"

namespace peclet::engine {
namespace {

// Returns a dense system of many blocks after some steps; `look` selects steps before which velocities are
// read.
template <class Look>
System after_steps(InstructionSet set, int threads, Look&& look) {
  const Physics physics =
      physics_with({.lubrication = true, .noise = true, .contact = true, .friction = true});
  System system = dense_suspension(physics, 4500, 12);
  constexpr double dt = 1e-6;
  VelocityVerlet integrator(ForceField(physics, system.particles, dt, 7, threads, set), system.particles, dt);
  integrator.start(system);
  EXPECT_EQ(system.list.blocks().size(), 2u);
  for (int step = 0; step < 12; ++step) {
    if (look(step)) integrator.complete(system);
    integrator.advance_open(system);
  }
  integrator.complete(system);
  return system;
}

void expect_same_motion(const System& one, const System& other) {
  EXPECT_EQ(one.particles.position, other.particles.position);
  EXPECT_EQ(one.particles.velocity, other.particles.velocity);
  EXPECT_EQ(one.particles.angular_velocity, other.particles.angular_velocity);
}

TEST(VelocityVerlet, StepsThatAreLeftOpenHaveTheSameBits) {
  const InstructionSet set = chosen_instruction_set();
  const System looked_at = after_steps(set, 1, [](int) { return true; });
  for (const int threads : {1, 2}) {
    const System open = after_steps(set, threads, [](int step) { return step == 5; });
    expect_same_motion(looked_at, open);
  }
}

// One thread moves particles and computes pairs in one loop over the blocks, several threads in two loops. A
// single loop must be repeated when the list is no longer valid.
void expect_the_same_bits_of_one_walk_or_two(const Physics& physics) {
  const auto after = [&](int threads) {
    System system = dense_suspension(physics, 9000, 12);
    constexpr double dt = 5e-4;
    VelocityVerlet integrator(ForceField(physics, system.particles, dt, 7, threads), system.particles, dt);
    integrator.start(system);
    for (int step = 0; step < 150; ++step) integrator.advance_open(system);
    integrator.complete(system);
    return system;
  };
  const System one = after(1), two = after(2);
  EXPECT_EQ(one.list.blocks().size(), 4u);
  EXPECT_GT(one.list.builds(), 2u);
  EXPECT_EQ(one.list.builds(), two.list.builds());
  EXPECT_EQ(one.particles.id, two.particles.id);
  expect_same_motion(one, two);
}

TEST(VelocityVerlet, OneWalkOrTwoHaveTheSameBits) {
  expect_the_same_bits_of_one_walk_or_two(
      physics_with({.lubrication = true, .noise = true, .contact = true}));
}

// In one loop a block moves and gets the flow of its new positions before the next block's pairs.
TEST(VelocityVerlet, OneWalkOrTwoHaveTheSameBitsInWavesThatLubricationFeels) {
  Physics physics = physics_with({.lubrication = true, .noise = true, .contact = true});
  physics.lubrication = LubricationParameters{
      .inner_gap = 1e-3, .form = LubricationParameters::Form::mari, .outer_distance = 0.05};
  physics.flow = ImposedFlow(std::make_shared<SteadyShear>(physics.flow.rate()),
                             std::make_shared<Waves>(std::vector<Wave>{{1, 0.4, 0.1}}, true));
  expect_the_same_bits_of_one_walk_or_two(physics);
}

// The loops over particles of each instruction set, compared with the baseline.
TEST(VelocityVerlet, MovesParticlesAlikeOnEveryInstructionSet) {
  const auto never = [](int) { return false; };
  const System expected = after_steps(InstructionSet::baseline, 1, never);
  for (const InstructionSet set : {InstructionSet::avx2, InstructionSet::avx512}) {
    if (!is_available(set)) {
      std::cout << "this processor has no " << name_of(set) << '\n';
      continue;
    }
    const System found = after_steps(set, 1, never);
    expect_near(components(expected.particles.position), components(found.particles.position),
                std::string(name_of(set)) + " positions");
    expect_near(components(expected.particles.velocity), components(found.particles.velocity),
                std::string(name_of(set)) + " velocities", 1e-10);
  }
}

}  // namespace
}  // namespace peclet::engine
