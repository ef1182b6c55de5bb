// The pair loop compared with itself on other instruction sets, threads and orders, and with a plain loop.
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <numbers>
#include <tuple>

#include "engine/flow/waves.h"
#include "engine/realisation/packing.h"
#include "tests/engine/available_sets.h"
#include "tests/engine/dense_suspension.h"
#include "tests/engine/draws.h"
#include "tests/engine/every_image.h"
#include "tests/engine/pair_evaluation.h"

namespace peclet::engine {
namespace {

const Physics with_all_terms = physics_with(all_terms);

TEST(PairPass, HasTheSameBitsOnAnyNumberOfThreads) {
  System system = dense_suspension(with_all_terms, 8500, 8);
  rebuild_neighbours(system);
  EXPECT_EQ(system.list.blocks().size(), 4u);
  expect_same_bits_on_threads(with_all_terms, system);
}

TEST(PairPass, EqualsItsSingleTwinOnEveryInstructionSetForEveryRecipe) {
  for (const InstructionSet set : newer_sets()) {
    for (const Terms& terms : every_recipe()) {
      const Physics physics = physics_with(terms);
      for (const std::size_t count : {2UL, 17UL, 200UL}) {
        expect_single_twin(physics, dense_suspension(physics, count == 2 ? 8 : count, count), set,
                           text(terms));
      }
    }
  }
}

// Laws that act on few or on all of eight pairs.
TEST(PairPass, EqualsItsSingleTwinForEveryConservativeLaw) {
  Physics both = physics_with({.lubrication = true, .contact = true, .conservative = true});
  both.attraction = AttractionParameters{.hamaker = 0.6, .regularisation = 0.01, .cutoff = 0.3};
  Physics attracting = both;
  attracting.repulsion.reset();
  Physics screened = both;
  screened.repulsion = RepulsionParameters{.cutoff_lengths = 6,
                                           .form = RepulsionParameters::Form::screened,
                                           .force = 1.3,
                                           .debye_length = 0.02,
                                           .reference_radius = 1};
  for (const InstructionSet set : newer_sets()) {
    for (const Physics& physics : {both, attracting, screened}) {
      expect_single_twin(physics, dense_suspension(physics, 200, 7), set, "");
    }
  }
}

// All terms at once over every pair in every image, one by one, without list or kernel.
TEST(PairPass, EqualsThePlainLoopOverAllPairs) {
  constexpr Terms terms = all_terms;
  const Physics& physics = with_all_terms;
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
    const std::uint32_t i = seen.first, j = seen.second;
    const PairKind& kind = kinds[2U * all.size_class[i] + all.size_class[j]];
    const ContactSprings before = held[{i, j, seen.image}];
    PairSpringsOf<double> springs = {before.tangential, before.rolling, before.slides};
    Vector3 velocity = all.velocity[j] - all.velocity[i];
    velocity += system.box.velocity(seen.image);
    const PairMotion motion = {velocity, all.angular_velocity[i], all.angular_velocity[j]};
    const TermLoadsOf<double> t = pair_terms<terms>(
        parameters, kind, geometry(seen.separation, kind), motion, springs,
        [&] {
          const NormalPair normals = random.normals(system.step, i, j, seen.image);
          return PairNormalsOf<double>{normals.first, normals.second};
        },
        [](StressTerm /*part*/, const Vector3& /*force*/) {});
    held[{i, j, seen.image}] = {springs.tangential, springs.rolling, springs.slides};
    PairLoad sum = t.lubrication;
    sum += t.noise;
    sum += t.springs.tangential;
    sum += t.springs.rolling;
    sum.force += t.contact_normal + t.contact_damping + t.conservative;
    force.add(i, sum.force);
    force.add(j, -sum.force);
    torque.add(i, sum.torque_first);
    torque.add(j, sum.torque_second);
  }
  for (std::uint32_t i = 0; i < 150; ++i) {
    const double a = all.radius[i], zeta = 6 * std::numbers::pi * physics.viscosity * a;
    const double zeta_r = 8 * std::numbers::pi * physics.viscosity * a * a * a;
    const NormalPair normals = single.normals(system.step, i);
    const double c = parameters.noise_amplitude;
    const Vector3 streaming = {physics.flow.rate() * all.position[i].y, 0, 0};
    const Vector3 spin = {0, 0, -0.5 * physics.flow.rate()};
    force.add(i, zeta * (streaming - all.velocity[i]) + c * std::sqrt(zeta) * normals.first);
    torque.add(i, zeta_r * (spin - all.angular_velocity[i]) + c * std::sqrt(zeta_r) * normals.second);
  }
  const Evaluation found = evaluated(physics, system, 1);
  expect_near(components(force), components(found.force), "force");
  expect_near(components(torque), components(found.torque), "torque");
  SpringField advanced = system.springs;
  for (std::size_t p = 0; p < advanced.size(); ++p) {
    const Pair& pair = system.list.pairs()[p];
    advanced.set(p, held[{pair.first, pair.second, system.list.images()[pair.image]}]);
  }
  expect_near(components(advanced), components(found.springs), "springs");
}

// Many blocks, with most pairs across their boundaries, compared with another order of particles in memory.
TEST(PairPass, DependsOnNoOrderOfTheParticlesInMemory) {
  const Physics physics =
      physics_with({.lubrication = true, .noise = true, .contact = true, .friction = true});
  System shuffled = dense_suspension(physics, 5000, 11), arranged = shuffled;
  rebuild_neighbours(shuffled);  // sorts along the curve
  rebuild_neighbours(arranged);
  // Sorted by id again, each block extends over the whole box.
  const std::vector<HeldContact> held = held_contacts(shuffled.list, shuffled.particles, shuffled.springs);
  std::vector<std::uint32_t> place(5000);
  for (std::uint32_t k = 0; k < 5000; ++k) place[arranged.particles.id[k]] = k;
  ParticleState in_order = make_particles(shuffled.particles.radius, 0.1);
  for (std::uint32_t i = 0; i < 5000; ++i) {
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
  VectorField force(5000), torque(5000);
  for (std::uint32_t i = 0; i < 5000; ++i) {
    force.set(i, a.force[place[i]]);
    torque.set(i, a.torque[place[i]]);
  }
  expect_near(components(force), components(b.force), "force");
  expect_near(components(torque), components(b.torque), "torque");
  expect_near(components(a.sums), components(b.sums), "stress");
  EXPECT_EQ(a.sums.contacts, b.sums.contacts);
}

// Loads across blocks are buffered in reused memory; separated pairs must leave nothing there.
TEST(PairPass, RemembersNoForceOfPairsThatHaveParted) {
  const Physics physics =
      physics_with({.lubrication = true, .contact = true, .friction = true, .conservative = true});
  System system = dense_suspension(physics, 8500, 14);
  rebuild_neighbours(system);
  ASSERT_GT(system.list.crossings(), 1000u);
  for (const InstructionSet set : {InstructionSet::baseline, chosen_instruction_set()}) {
    ForceField used(physics, system.particles, timestep, seed, 1, set);
    System before = system;
    VectorField force(8500), torque(8500);
    used.evaluate(before, force, torque);
    // Stretched along x some pairs leave their range; at twice the size all do.
    for (const double factor : {1.02, 2.0}) {
      System drawn = system;
      for (std::size_t i = 0; i < 8500; ++i) {
        const Vector3 x = drawn.particles.position[i];
        drawn.particles.position.set(
            i, {factor * x.x, factor == 2 ? 2 * x.y : x.y, factor == 2 ? 2 * x.z : x.z});
      }
      const Evaluation fresh = evaluated(physics, drawn, 1, set);
      used.evaluate(drawn, force, torque);
      EXPECT_EQ(components(fresh.force), components(force)) << factor;
      EXPECT_EQ(components(fresh.torque), components(torque)) << factor;
    }
  }
}

// The test leaves out noise, which depends on particle ids.
TEST(PairPass, NumberingTheParticlesOtherwiseOnlyRenamesTheForces) {
  const Physics physics =
      physics_with({.lubrication = true, .contact = true, .damping = true, .conservative = true});
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
      expect_single_twin(physics, dense_suspension(physics, 200, 12), set, text(terms));
    }
  }
}

TEST(StrainedPairs, HaveTheSameBitsOnAnyNumberOfThreads) {
  const Physics physics = wavy(physics_with(
      {.lubrication = true, .noise = true, .strained = true, .contact = true, .friction = true}));
  System system = dense_suspension(physics, 8500, 8);
  rebuild_neighbours(system);
  ASSERT_EQ(system.list.blocks().size(), 4u);
  expect_same_bits_on_threads(physics, system);
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
