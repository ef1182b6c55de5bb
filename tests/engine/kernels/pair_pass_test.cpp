// The pair loop compared with its terms one by one, for every compiled combination.
#include <gtest/gtest.h>

#include "tests/engine/dense_suspension.h"
#include "tests/engine/every_image.h"
#include "tests/engine/pair_evaluation.h"

namespace peclet::engine {
namespace {

// Returns the normal vectors that a force field of this seed uses at the system's step.
GivenNoise noise_of(const System& system) {
  const KeyedRandom one_body(seed, Purpose::one_body_noise), pairwise(seed, Purpose::pair_noise);
  const std::size_t count = system.particles.count();
  GivenNoise noise{timestep, VectorField(count), VectorField(count), {}};
  for (std::uint32_t i = 0; i < count; ++i) {
    const NormalPair normals = one_body.normals(system.step, i);
    noise.force.set(i, normals.first);
    noise.torque.set(i, normals.second);
  }
  for (const Pair& pair : system.list.pairs()) {
    const LatticeShift image = system.list.images()[pair.image];
    noise.pairs.push_back(
        {pair.first, pair.second, image, pairwise.normals(system.step, pair.first, pair.second, image)});
  }
  return noise;
}

Vector3 vector_from(const Json& v) { return {v[0], v[1], v[2]}; }

// Returns the sum of all terms of a block, as one list of components.
std::vector<double> summed(const Json& block, std::size_t count) {
  std::vector<double> sum(3 * count);
  for (const Json& term : block) {
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t k = 0; k < 3; ++k) sum[3 * i + k] += term[i][k].get<double>();
    }
  }
  return sum;
}

// Results of single evaluations: springs advanced by one step, and the loads of these springs.
struct OneByOne {
  Json loads;
  std::vector<HeldContact> springs;
};

OneByOne one_by_one(const System& system, const Physics& physics) {
  Configuration configuration = configuration_of(system, physics);
  if (physics.thermal_energy > 0) configuration.noise = noise_of(system);
  configuration.advance = timestep;
  const Json springs = evaluate_configuration(configuration).at("springs");
  configuration.advance.reset();
  configuration.springs.clear();
  for (const Json& spring : springs) {
    configuration.springs.push_back({spring["i"],
                                     spring["j"],
                                     {spring["image"][0], spring["image"][1], spring["image"][2]},
                                     {vector_from(spring["tangential"]), vector_from(spring["rolling"]),
                                      spring.value("slides", false) ? 1.0 : 0.0}});
  }
  sort_contacts(configuration.springs);
  return {evaluate_configuration(configuration), configuration.springs};
}

TEST(PairPass, EqualsTheSumOfItsTermsForEveryRecipe) {
  const std::vector<Terms> recipes = every_recipe();
  ASSERT_EQ(recipes.size(), 110u);
  for (const Terms& terms : recipes) {
    const Physics physics = physics_with(terms);
    ASSERT_EQ(required_terms(physics), terms) << text(terms);
    System system = dense_suspension(physics, 200, 3);
    system.step = 17;
    const OneByOne expected = one_by_one(system, physics);
    const std::size_t count = system.particles.count();
    VectorField force(count), torque(count);
    const PairSums sums =
        ForceField(physics, system.particles, timestep, seed, 1).evaluate(system, force, torque);
    expect_near(summed(expected.loads["force"], count), components(force), text(terms) + "force");
    expect_near(summed(expected.loads["torque"], count), components(torque), text(terms) + "torque");
    for (std::size_t t = 0; t < count_of_stress_terms; ++t) {
      const auto term = static_cast<StressTerm>(t);
      const SymmetricTensor s = (1 / system.box.volume()) * sums.stress[t];
      Json zero = {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
      const Json m = has_stress_term(physics, term) ? expected.loads["stress"].at(name_of(term)) : zero;
      expect_near({m[0][0], m[1][1], m[2][2], m[0][1], m[0][2], m[1][2]},
                  {s.xx, s.yy, s.zz, s.xy, s.xz, s.yz}, text(terms) + "stress of " + name_of(term));
    }
  }
}

TEST(PairPass, AdvancesTheSpringsOfEveryContactAndNoOther) {
  for (const bool more : {false, true}) {
    const Physics physics =
        physics_with({.contact = true, .friction = true, .rolling = more, .kinetic = more});
    System system = dense_suspension(physics, 200, 4);
    const OneByOne expected = one_by_one(system, physics);
    VectorField force(200), torque(200);
    ForceField(physics, system.particles, timestep, seed, 1).evaluate(system, force, torque);
    const std::vector<HeldContact> found =
        held_contacts(system.list, configuration_of(system, physics).particles, system.springs);
    ASSERT_GT(found.size(), 100u);
    ASSERT_EQ(found.size(), expected.springs.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_EQ(found[k].first, expected.springs[k].first);
      EXPECT_EQ(found[k].image, expected.springs[k].image);
      EXPECT_EQ(norm(found[k].springs.tangential - expected.springs[k].springs.tangential), 0);
      EXPECT_EQ(norm(found[k].springs.rolling - expected.springs[k].springs.rolling), 0);
      EXPECT_EQ(found[k].springs.slides, expected.springs[k].springs.slides);
    }
  }
}

TEST(PairPass, CountsContactsAndMeasuresTheLargestOverlap) {
  const Physics physics = physics_with({.lubrication = true, .contact = true});
  System system = dense_suspension(physics, 300, 6);
  const std::vector<double>& radius = system.particles.radius;
  const auto touching = every_image(system.particles.position, system.box.lengths(), system.box.tilt(),
                                    [&](std::uint32_t i, std::uint32_t j) { return radius[i] + radius[j]; });
  double largest = 0;
  for (const SeenPair& pair : touching) {
    const double overlap = radius[pair.first] + radius[pair.second] - norm(pair.separation);
    largest = std::max(largest, overlap / std::min(radius[pair.first], radius[pair.second]));
  }
  VectorField force(300), torque(300);
  const PairSums sums =
      ForceField(physics, system.particles, timestep, seed, 1).evaluate(system, force, torque);
  EXPECT_GT(sums.contacts, 100u);
  EXPECT_EQ(sums.contacts, touching.size());
  EXPECT_NEAR(sums.largest_overlap, largest, 1e-12);
  EXPECT_TRUE(sums.finite);
}

TEST(PairPass, NoticesAPositionThatIsNotFinite) {
  const Physics physics = physics_with({.contact = true});
  System system = dense_suspension(physics, 50, 6);
  system.particles.position.set(20, {1, std::nan(""), 1});
  VectorField force(50), torque(50);
  EXPECT_FALSE(
      ForceField(physics, system.particles, timestep, seed, 1).evaluate(system, force, torque).finite);
}

}  // namespace
}  // namespace peclet::engine
