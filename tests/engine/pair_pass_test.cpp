// The hot loop against the same terms one by one, for every compiled combination.
#include <gtest/gtest.h>

#include <map>

#include "engine/kernels/force_field.h"
#include "engine/kernels/recipes.h"
#include "tests/engine/bits.h"
#include "tests/engine/dense_suspension.h"
#include "tests/engine/every_image.h"

namespace peclet::engine {
namespace {

constexpr double timestep = 1e-4;
constexpr std::uint64_t seed = 5;
constexpr double tolerance = 1e-12;  // of the largest component: only the order of the sums differs

std::vector<Terms> every_recipe() {
  std::vector<Terms> recipes;
  for (unsigned code = 0; code < count_of_codes; ++code) {
    if (decoded_terms(code).valid()) {
      recipes.push_back(decoded_terms(code));
    }
  }
  return recipes;
}

std::string text(const Terms& terms) {
  std::string all;
  const auto add = [&all](const char* name, bool present) { all += present ? std::string(name) + ' ' : ""; };
  add("lubrication", terms.lubrication);
  add("noise", terms.noise);
  add("contact", terms.contact);
  add("damping", terms.damping);
  add("friction", terms.friction);
  add("rolling", terms.rolling);
  add("repulsion", terms.repulsion);
  return all;
}

// The normal vectors that a force field of this seed uses at the system's step.
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

// Sum of all terms of a block, as one list of components.
std::vector<double> summed(const Json& block, std::size_t count) {
  std::vector<double> sum(3 * count);
  for (const Json& term : block) {
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        sum[3 * i + k] += term[i][k].get<double>();
      }
    }
  }
  return sum;
}

std::vector<double> components(const VectorField& field) {
  std::vector<double> all;
  for (std::size_t i = 0; i < field.size(); ++i) {
    all.insert(all.end(), {field.x[i], field.y[i], field.z[i]});
  }
  return all;
}

void expect_near(const std::vector<double>& expected, const std::vector<double>& found,
                 const std::string& what) {
  ASSERT_EQ(expected.size(), found.size()) << what;
  double scale = 0, worst = 0;
  for (std::size_t k = 0; k < expected.size(); ++k) {
    scale = std::max(scale, std::abs(expected[k]));
    worst = std::max(worst, std::abs(expected[k] - found[k]));
  }
  EXPECT_LE(worst, tolerance * scale) << what;
}

// The answer of single evaluations: springs advanced by one step, and the loads of these springs.
struct OneByOne {
  Json loads;
  std::vector<HeldContact> springs;
};

OneByOne one_by_one(const System& system, const Physics& physics) {
  Configuration configuration = configuration_of(system, physics);
  if (physics.thermal_energy > 0) {
    configuration.noise = noise_of(system);
  }
  configuration.advance = timestep;
  const Json springs = evaluate_configuration(configuration).at("springs");
  configuration.advance.reset();
  configuration.springs.clear();
  for (const Json& spring : springs) {
    configuration.springs.push_back({spring["i"],
                                     spring["j"],
                                     {spring["image"][0], spring["image"][1], spring["image"][2]},
                                     {vector_from(spring["tangential"]), vector_from(spring["rolling"])}});
  }
  return {evaluate_configuration(configuration), configuration.springs};
}

TEST(PairPass, EqualsTheSumOfItsTermsForEveryRecipe) {
  const std::vector<Terms> recipes = every_recipe();
  ASSERT_EQ(recipes.size(), 42u);
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
      const Json m = has_stress_term(terms, term) ? expected.loads["stress"].at(name_of(term)) : zero;
      expect_near({m[0][0], m[1][1], m[2][2], m[0][1], m[0][2], m[1][2]},
                  {s.xx, s.yy, s.zz, s.xy, s.xz, s.yz}, text(terms) + "stress of " + name_of(term));
    }
  }
}

TEST(PairPass, AdvancesTheSpringsOfEveryContactAndNoOther) {
  for (const bool rolling : {false, true}) {
    const Physics physics = physics_with({.contact = true, .friction = true, .rolling = rolling});
    System system = dense_suspension(physics, 200, 4);
    const OneByOne expected = one_by_one(system, physics);
    VectorField force(200), torque(200);
    ForceField(physics, system.particles, timestep, seed, 1).evaluate(system, force, torque);
    const std::vector<HeldContact> found =
        held_contacts(system.list, std::vector<LatticeShift>(200), system.springs);
    ASSERT_GT(found.size(), 100u);
    ASSERT_EQ(found.size(), expected.springs.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_EQ(found[k].first, expected.springs[k].first);
      EXPECT_EQ(found[k].image, expected.springs[k].image);
      EXPECT_EQ(norm(found[k].springs.tangential - expected.springs[k].springs.tangential), 0);
      EXPECT_EQ(norm(found[k].springs.rolling - expected.springs[k].springs.rolling), 0);
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
  system.particles.position.y[20] = std::nan("");
  VectorField force(50), torque(50);
  EXPECT_FALSE(
      ForceField(physics, system.particles, timestep, seed, 1).evaluate(system, force, torque).finite);
}

struct Evaluation {
  VectorField force, torque;
  PairSums sums;
  std::vector<ContactSprings> springs;
};

Evaluation evaluated(const Physics& physics, System system, int threads) {
  const std::size_t count = system.particles.count();
  Evaluation result{VectorField(count), VectorField(count), {}, {}};
  result.sums = ForceField(physics, system.particles, timestep, seed, threads)
                    .evaluate(system, result.force, result.torque);
  result.springs = system.springs;
  return result;
}

TEST(PairPass, HasTheSameBitsOnAnyNumberOfThreads) {
  const Physics physics = physics_with({.lubrication = true,
                                        .noise = true,
                                        .contact = true,
                                        .damping = true,
                                        .friction = true,
                                        .rolling = true,
                                        .repulsion = true});
  const System system = dense_suspension(physics, 400, 8);
  const Evaluation one = evaluated(physics, system, 1);
  for (const int threads : {2, 3}) {
    const Evaluation many = evaluated(physics, system, threads);
    EXPECT_EQ(components(one.force), components(many.force)) << threads;
    EXPECT_EQ(components(one.torque), components(many.torque)) << threads;
    EXPECT_EQ(bits_of(one.sums.stress), bits_of(many.sums.stress)) << threads;
    EXPECT_EQ(one.sums.contacts, many.sums.contacts);
    EXPECT_EQ(one.sums.largest_overlap, many.sums.largest_overlap);
    ASSERT_EQ(one.springs.size(), many.springs.size());
    for (std::size_t p = 0; p < one.springs.size(); ++p) {
      EXPECT_EQ(bits_of(one.springs[p]), bits_of(many.springs[p])) << threads;
    }
  }
}

// Without noise, which knows particles by their number.
TEST(PairPass, NumberingTheParticlesOtherwiseOnlyRenamesTheForces) {
  const Physics physics =
      physics_with({.lubrication = true, .contact = true, .damping = true, .repulsion = true});
  const System system = dense_suspension(physics, 150, 9);
  System reversed = system;
  const std::size_t count = system.particles.count();
  std::vector<double> radius(system.particles.radius.rbegin(), system.particles.radius.rend());
  reversed.particles = make_particles(radius, 0.1);
  for (std::size_t i = 0; i < count; ++i) {
    reversed.particles.position.set(i, system.particles.position[count - 1 - i]);
    reversed.particles.velocity.set(i, system.particles.velocity[count - 1 - i]);
    reversed.particles.angular_velocity.set(i, system.particles.angular_velocity[count - 1 - i]);
  }
  reversed.list.build(reversed.particles, reversed.box);
  reversed.springs.assign(reversed.list.pairs().size(), {});
  const Evaluation there = evaluated(physics, system, 1), back = evaluated(physics, reversed, 1);
  VectorField force(count), torque(count);
  for (std::size_t i = 0; i < count; ++i) {
    force.set(i, back.force[count - 1 - i]);
    torque.set(i, back.torque[count - 1 - i]);
  }
  expect_near(components(there.force), components(force), "force");
  expect_near(components(there.torque), components(torque), "torque");
}

}  // namespace
}  // namespace peclet::engine
