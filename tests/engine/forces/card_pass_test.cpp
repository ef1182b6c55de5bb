// The kernels for cards give the loads of the processor's, in every combination of terms.
#include "engine/forces/card_pass.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "engine/flow/waves.h"
#include "tests/engine/dense_suspension.h"
#include "tests/engine/draws.h"
#include "tests/engine/pair_evaluation.h"

namespace peclet::engine {
namespace {

TEST(CardPass, EqualsThePairPassInEveryRecipe) {
  for (const Terms& terms : every_recipe()) {
    Physics physics = physics_with(terms);
    if (terms.friction) {
      physics.contact->critical_load = 100;
      physics.contact->largest_load = 300;
    }
    const System system = dense_suspension(physics, 203, 7);
    const std::vector<PairKind> kinds = make_pair_kinds(physics, distinct_radii(system.particles.radius));
    Draws draws(3);
    std::vector<NormalPair> normals(system.list.pairs().size());
    for (NormalPair& pair : normals) pair = {draws.vector(), draws.vector()};
    const PairPassInput input = {.particles = system.particles,
                                 .list = system.list,
                                 .box = system.box,
                                 .kinds = kinds,
                                 .parameters = pair_parameters(physics, timestep),
                                 .noise = {},
                                 .given_noise = &normals};
    const std::size_t count = system.particles.count();
    Evaluation expected{VectorField(count), VectorField(count), {}, system.springs}, found = expected;
    expected.sums = PairPass(terms, InstructionSet::baseline)
                        .evaluate(input, expected.springs, expected.force, expected.torque);
    found.sums = evaluate_as_card(physics, terms, input, found.springs, found.force, found.torque);
    expect_near(components(expected.force), components(found.force), text(terms) + "force");
    expect_near(components(expected.torque), components(found.torque), text(terms) + "torque");
    expect_near(components(expected.sums), components(found.sums), text(terms) + "stress");
    expect_near(components(expected.springs), components(found.springs), text(terms) + "springs");
  }
}

TEST(CardPass, RefusesWavesAndImagesFarAway) {
  Physics physics = physics_with({.lubrication = true});
  System system = dense_suspension(physics, 30, 7);
  EXPECT_FALSE(refusal_by_card(physics, system.list));
  Physics wavy = physics;
  wavy.flow = ImposedFlow(std::make_shared<SteadyShear>(0.7),
                          std::make_shared<Waves>(std::vector<Wave>{{1, 0.4, 0.1}}, false));
  EXPECT_TRUE(refusal_by_card(wavy, system.list));
  const Vector3 far = system.box.displacement({128, 0, 0});
  for (std::size_t i = 1; i < system.particles.count(); i += 2) {
    system.particles.position.set(i, system.particles.position[i] + far);
  }
  system.list.build(system.particles, system.box);
  EXPECT_TRUE(refusal_by_card(physics, system.list));
}

TEST(EmulatedCard, IsNoInstructionSetOfRuns) {
  setenv("PECLET_INSTRUCTION_SET", "emulated", 1);
  EXPECT_TRUE(emulated_card_is_chosen());
  try {
    chosen_instruction_set();
    ADD_FAILURE() << "there is no such set";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("PECLET_DEVICE=emulated"), std::string::npos) << error.what();
  }
  unsetenv("PECLET_INSTRUCTION_SET");
  EXPECT_FALSE(emulated_card_is_chosen());
}

}  // namespace
}  // namespace peclet::engine
