// The hot loop against the same terms one by one, for every compiled combination.
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <tuple>

#include "engine/kernels/force_field.h"
#include "engine/kernels/recipes.h"
#include "engine/terms/drag.h"
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
    all.insert(all.end(), {field[i].x, field[i].y, field[i].z});
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
  sort_contacts(configuration.springs);
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
        held_contacts(system.list, configuration_of(system, physics).particles, system.springs);
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
  system.particles.position.set(20, {1, std::nan(""), 1});
  VectorField force(50), torque(50);
  EXPECT_FALSE(
      ForceField(physics, system.particles, timestep, seed, 1).evaluate(system, force, torque).finite);
}

struct Evaluation {
  VectorField force, torque;
  PairSums sums;
  SpringField springs;
};

Evaluation evaluated(const Physics& physics, System system, int threads,
                     InstructionSet set = chosen_instruction_set()) {
  const std::size_t count = system.particles.count();
  Evaluation result{VectorField(count), VectorField(count), {}, {}};
  result.sums = ForceField(physics, system.particles, timestep, seed, threads, set)
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
  System system = dense_suspension(physics, 4500, 8);
  rebuild_neighbours(system);
  EXPECT_EQ(system.list.blocks().size(), 3u);
  const Evaluation one = evaluated(physics, system, 1);
  for (const int threads : {2, 3}) {
    const Evaluation many = evaluated(physics, system, threads);
    EXPECT_EQ(components(one.force), components(many.force)) << threads;
    EXPECT_EQ(components(one.torque), components(many.torque)) << threads;
    EXPECT_EQ(bits_of(std::to_array(one.sums.stress)), bits_of(std::to_array(many.sums.stress))) << threads;
    EXPECT_EQ(one.sums.contacts, many.sums.contacts);
    EXPECT_EQ(one.sums.largest_overlap, many.sums.largest_overlap);
    ASSERT_EQ(one.springs.size(), many.springs.size());
    for (std::size_t p = 0; p < one.springs.size(); ++p) {
      EXPECT_EQ(bits_of(one.springs[p]), bits_of(many.springs[p])) << threads;
    }
  }
}

std::vector<double> components(const PairSums& sums) {
  std::vector<double> all;
  for (const SymmetricTensor& s : sums.stress) {
    all.insert(all.end(), {s.xx, s.yy, s.zz, s.xy, s.xz, s.yz});
  }
  return all;
}

std::vector<double> components(const SpringField& springs) {
  std::vector<double> all;
  for (std::size_t c = 0; c < springs.components(); ++c) {
    all.insert(all.end(), springs.values(c).begin(), springs.values(c).end());
  }
  return all;
}

void expect_equal(const Evaluation& a, const Evaluation& b, const std::string& what) {
  expect_near(components(a.force), components(b.force), what + " force");
  expect_near(components(a.torque), components(b.torque), what + " torque");
  expect_near(components(a.sums), components(b.sums), what + " stress");
  expect_near(components(a.springs), components(b.springs), what + " springs");
  EXPECT_EQ(a.sums.contacts, b.sums.contacts) << what;
  EXPECT_NEAR(a.sums.largest_overlap, b.sums.largest_overlap, 1e-15) << what;
}

TEST(PairPass, EqualsItsSingleTwinOnEveryInstructionSetForEveryRecipe) {
  for (const InstructionSet set : {InstructionSet::avx2, InstructionSet::avx512}) {
    if (!is_available(set)) continue;
    for (const Terms& terms : every_recipe()) {
      const Physics physics = physics_with(terms);
      for (const std::size_t count : {2UL, 17UL, 200UL}) {
        const System system = dense_suspension(physics, count == 2 ? 8 : count, count);
        expect_equal(evaluated(physics, system, 1, InstructionSet::baseline),
                     evaluated(physics, system, 1, set), text(terms) + name_of(set));
      }
    }
  }
}

// All terms at once over every pair in every image, one by one, with no list and no kernel.
TEST(PairPass, EqualsThePlainLoopOverAllPairs) {
  constexpr Terms terms = {.lubrication = true,
                           .noise = true,
                           .contact = true,
                           .damping = true,
                           .friction = true,
                           .rolling = true,
                           .repulsion = true};
  const Physics physics = physics_with(terms);
  System system = dense_suspension(physics, 150, 10);
  system.step = 3;
  const ParticleState& all = system.particles;
  const std::vector<PairKind> kinds = make_pair_kinds(physics, {1, 1.4});
  const KeyedRandom random(seed, Purpose::pair_noise), single(seed, Purpose::one_body_noise);
  std::map<std::tuple<std::uint32_t, std::uint32_t, LatticeShift>, ContactSprings> held;
  for (std::size_t p = 0; p < system.springs.size(); ++p) {
    const Pair& pair = system.list.pairs()[p];
    held[{pair.first, pair.second, system.list.images()[pair.image]}] = system.springs[p];
  }
  const PairParameters parameters = pair_parameters(physics, timestep);
  VectorField force(150), torque(150);
  const auto range = [&](std::uint32_t i, std::uint32_t j) {
    return kinds[2U * all.size_class[i] + all.size_class[j]].range;
  };
  for (const SeenPair& seen : every_image(all.position, system.box.lengths(), system.box.tilt(), range)) {
    const auto [i, j] = std::pair(seen.first, seen.second);
    const PairKind& kind = kinds[2U * all.size_class[i] + all.size_class[j]];
    const ContactSprings before = held[{i, j, seen.image}];
    PairSpringsOf<double> springs = {before.tangential, before.rolling};
    Vector3 velocity = all.velocity[j] - all.velocity[i];
    velocity.x += system.box.velocity_offset(seen.image);
    const PairMotion motion = {velocity, all.angular_velocity[i], all.angular_velocity[j]};
    const TermLoadsOf<double> t =
        pair_terms<terms>(parameters, kind, geometry(seen.separation, kind), motion, springs, [&] {
          const NormalPair normals = random.normals(system.step, i, j, seen.image);
          return PairNormalsOf<double>{normals.first, normals.second};
        });
    PairLoad sum = t.lubrication;
    sum += t.noise;
    sum += t.friction;
    sum += t.rolling;
    sum.force += t.contact_normal + t.contact_damping + t.repulsion;
    force.add(i, sum.force);
    force.add(j, -sum.force);
    torque.add(i, sum.torque_first);
    torque.add(j, sum.torque_second);
  }
  for (std::uint32_t i = 0; i < 150; ++i) {
    const double zeta = translational_drag(physics.viscosity, all.radius[i]);
    const double zeta_r = rotational_drag(physics.viscosity, all.radius[i]);
    const NormalPair normals = single.normals(system.step, i);
    const double c = parameters.noise_amplitude;
    force.add(i,
              drag_force(zeta, streaming_velocity(physics.shear_rate, all.position[i].y), all.velocity[i]) +
                  drag_noise_amplitude(c, zeta) * normals.first);
    torque.add(i, drag_force(zeta_r, streaming_spin(physics.shear_rate), all.angular_velocity[i]) +
                      drag_noise_amplitude(c, zeta_r) * normals.second);
  }
  const Evaluation found = evaluated(physics, system, 1);
  expect_near(components(force), components(found.force), "force");
  expect_near(components(torque), components(found.torque), "torque");
}

// Many blocks, of which most pairs cross the boundaries, and one: another order of particles in memory.
TEST(PairPass, DependsOnNoOrderOfTheParticlesInMemory) {
  const Physics physics =
      physics_with({.lubrication = true, .noise = true, .contact = true, .friction = true});
  System shuffled = dense_suspension(physics, 3000, 11), arranged = shuffled;
  rebuild_neighbours(shuffled);  // along the curve
  rebuild_neighbours(arranged);
  // Back in the order of their ids, each block is all over the box.
  const std::vector<HeldContact> held = held_contacts(shuffled.list, shuffled.particles, shuffled.springs);
  std::vector<std::uint32_t> place(3000);
  for (std::uint32_t k = 0; k < 3000; ++k) place[arranged.particles.id[k]] = k;
  ParticleState in_order = make_particles(shuffled.particles.radius, 0.1);
  for (std::uint32_t i = 0; i < 3000; ++i) {
    const std::uint32_t k = place[i];
    in_order.radius[i] = arranged.particles.radius[k];
    in_order.mass[i] = arranged.particles.mass[k];
    in_order.inertia[i] = arranged.particles.inertia[k];
    in_order.size_class[i] = arranged.particles.size_class[k];
    in_order.position.set(i, arranged.particles.position[k]);
    in_order.velocity.set(i, arranged.particles.velocity[k]);
    in_order.angular_velocity.set(i, arranged.particles.angular_velocity[k]);
    in_order.image[i] = arranged.particles.image[k];
  }
  shuffled.particles = in_order;
  shuffled.list.build(shuffled.particles, shuffled.box);
  shuffled.springs = placed_contacts(shuffled.list, shuffled.particles, held, SpringKinds::tangential);
  EXPECT_GT(shuffled.list.crossings(), 2 * arranged.list.crossings());
  const Evaluation a = evaluated(physics, arranged, 1), b = evaluated(physics, shuffled, 2);
  VectorField force(3000), torque(3000);
  for (std::uint32_t i = 0; i < 3000; ++i) {
    force.set(i, a.force[place[i]]);
    torque.set(i, a.torque[place[i]]);
  }
  expect_near(components(force), components(b.force), "force");
  expect_near(components(torque), components(b.torque), "torque");
  expect_near(components(a.sums), components(b.sums), "stress");
  EXPECT_EQ(a.sums.contacts, b.sums.contacts);
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
