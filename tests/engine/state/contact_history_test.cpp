#include "engine/state/contact_history.h"

#include <gtest/gtest.h>

#include <map>

#include "engine/kernels/force_field.h"
#include "tests/engine/bits.h"
#include "tests/engine/dense_suspension.h"
#include "tests/engine/pair_evaluation.h"

namespace peclet::engine {
namespace {

const Physics physics = physics_with({.lubrication = true,
                                      .contact = true,
                                      .damping = true,
                                      .friction = true,
                                      .rolling = true,
                                      .conservative = true,
                                      .kinetic = true});

// Expects equal forces and torques at a timestep of 0, which leaves the springs unchanged.
void expect_same_loads(const System& before, const System& after) {
  const auto loads_of = [](System system) {
    const std::size_t count = system.particles.count();
    VectorField force(count), torque(count);
    ForceField(physics, system.particles, 0, 1, 1).evaluate(system, force, torque);
    std::vector<double> all = components(force);
    const std::vector<double> torques = components(torque);
    all.insert(all.end(), torques.begin(), torques.end());
    return all;
  };
  expect_near(loads_of(before), loads_of(after), "loads", 1e-12);
}

// Returns the springs of all contacts by their particles; no pair touches in two images here.
std::map<std::pair<std::uint32_t, std::uint32_t>, ContactSprings> springs_by_particles(const System& system) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, ContactSprings> springs;
  for (const HeldContact& held : held_contacts(system.list, system.particles, system.springs)) {
    EXPECT_TRUE(springs.emplace(std::pair(held.first, held.second), held.springs).second);
  }
  return springs;
}

void expect_same_springs(const System& before, const System& after) {
  const auto a = springs_by_particles(before), b = springs_by_particles(after);
  ASSERT_GT(a.size(), 100u);
  ASSERT_EQ(a.size(), b.size());
  for (const auto& [particles, springs] : a) {
    ASSERT_TRUE(b.count(particles));
    EXPECT_EQ(bits_of(springs), bits_of(b.at(particles)));
  }
}

TEST(ContactHistory, SurvivesWrapping) {
  const System before = dense_suspension(physics, 200, 1);  // a third of the particles lies outside the cell
  System after = before;
  rebuild_neighbours(after);
  EXPECT_EQ(after.box.basis(), BasisChange{});
  EXPECT_NE(after.particles.image, before.particles.image);
  expect_same_springs(before, after);
  expect_same_loads(before, after);
}

TEST(ContactHistory, SurvivesFlipsInEitherDirection) {
  for (const std::int32_t count : {-2, -1, 1}) {
    System before = dense_suspension(physics, 200, 2);
    before.box.change_basis(flips(count));  // another basis of the lattice, too steep
    before.list.build(before.particles, before.box);
    const System original = dense_suspension(physics, 200, 2);
    std::vector<HeldContact> held = held_contacts(original.list, original.particles, original.springs);
    for (HeldContact& contact : held) contact.image = flips(count).after(contact.image);
    before.springs = placed_contacts(before.list, before.particles, held, original.springs.kinds());
    System after = before;
    rebuild_neighbours(after);
    EXPECT_EQ(after.box.basis(), BasisChange{});
    expect_same_springs(original, before);
    expect_same_springs(before, after);
    expect_same_loads(original, after);
  }
}

void forget_springs(System& system) {
  system.springs = SpringField(system.springs.kinds(), system.list.pairs().size());
}

// All particles drift together several times through the cell; their relative positions are constant.
TEST(ContactHistory, SurvivesManyPassagesThroughTheBoundaries) {
  const System start = dense_suspension(physics, 200, 3);
  System system = start;
  const Vector3 way = {2.9, 1.7, -2.3};
  for (int step = 0; step < 12; ++step) {
    for (std::size_t i = 0; i < 200; ++i) {
      system.particles.position.set(i, system.particles.position[i] + way);
      system.particles.velocity.add(i, {physics.flow.rate() * way.y, 0, 0});
    }
    rebuild_neighbours(system);
    expect_same_springs(start, system);
  }
  expect_same_loads(start, system);
}

// Particles carried by the flow through strains with several box flips end where the flow takes them.
TEST(ContactHistory, UnwrappedPlacesFollowTheFlowThroughFlips) {
  System system = dense_suspension(physics, 50, 3);
  forget_springs(system);
  rebuild_neighbours(system);
  const auto unwrapped = [&](std::size_t i) {
    return system.particles.position[i] + system.box.displacement(system.particles.image[i]);
  };
  std::vector<Vector3> expected;
  for (std::size_t i = 0; i < 50; ++i) {
    const Vector3 x = unwrapped(i);
    expected.push_back(x + Vector3{2.4 * x.y, 0, 0});
  }
  for (int step = 1; step <= 12; ++step) {
    for (std::size_t i = 0; i < 50; ++i) {
      system.particles.position.add(i, {0.2 * system.particles.position[i].y, 0, 0});
    }
    system.box.deform(simple_shear(0.2 * step));
    rebuild_neighbours(system);
  }
  EXPECT_EQ(system.box.basis(), flips(3));  // the tilt grows from 0.31 to 2.71 edges
  for (std::size_t i = 0; i < 50; ++i) EXPECT_NEAR(norm(unwrapped(i) - expected[i]), 0, 1e-10);
}

TEST(ContactHistory, ForgetsWhatIsFarApartByNow) {
  System system = dense_suspension(physics, 60, 4);
  std::vector<HeldContact> held = held_contacts(system.list, system.particles, system.springs);
  const std::size_t kept = held.size();
  held.push_back({0, 1, {9, 9, 9}, {{1, 0, 0}, {}}});
  sort_contacts(held);
  system.springs = placed_contacts(system.list, system.particles, held, system.springs.kinds());
  EXPECT_EQ(held_contacts(system.list, system.particles, system.springs).size(), kept);
}

// A sliding contact is stored even if its springs are zero.
TEST(ContactHistory, ContactsThatSlideAreHeldWithoutASpring) {
  System system = dense_suspension(physics, 60, 4);
  forget_springs(system);
  EXPECT_TRUE(held_contacts(system.list, system.particles, system.springs).empty());
  system.springs.set(5, {{}, {}, 1});
  const std::vector<HeldContact> held = held_contacts(system.list, system.particles, system.springs);
  ASSERT_EQ(held.size(), 1u);
  EXPECT_EQ(held[0].springs.slides, 1);
  rebuild_neighbours(system);
  EXPECT_EQ(springs_by_particles(system).at({held[0].first, held[0].second}).slides, 1);
}

TEST(ContactHistory, HasRoomForWhatIsRemembered) {
  const std::pair<SpringKinds, std::size_t> rooms[] = {{SpringKinds::none, 0},
                                                       {SpringKinds::tangential, 3},
                                                       {SpringKinds::tangential_and_rolling, 6},
                                                       {SpringKinds::tangential_that_slide, 4},
                                                       {SpringKinds::tangential_and_rolling_that_slide, 7}};
  for (const auto& [kinds, components] : rooms) {
    SpringField field(kinds, 2);
    EXPECT_EQ(field.components(), components);
    field.set(1, {{1, 2, 3}, {4, 5, 6}, 1});
    EXPECT_EQ(field[1].tangential.z, components >= 3 ? 3 : 0);
    EXPECT_EQ(field[1].rolling.z, components >= 6 ? 6 : 0);
    EXPECT_EQ(field[1].slides, components % 3);
    EXPECT_EQ(norm(field[0].tangential), 0);
    EXPECT_EQ(field[0].slides, 0);
  }
}

}  // namespace
}  // namespace peclet::engine
