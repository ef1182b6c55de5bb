// Springs of sliding and of rolling: kinematics, loads and memory.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "engine/terms/lubrication.h"
#include "engine/terms/spring_laws.h"
#include "tests/engine/pair_loads.h"

namespace peclet::engine {
namespace {

constexpr Vector3 n = {0, 0, 1};
constexpr double boundless = std::numeric_limits<double>::infinity();

// Returns a contact of radii 1 and `ratio` with k_t = 3000 and k_r = 700.
ContactOf<double> contact_at(const PairGeometry& pair, double ratio) {
  static constexpr ContactParameters parameters = {.tangential_stiffness = 3e3, .rolling_stiffness = 700};
  return {parameters, pair, contact_levers(1, ratio, pair), 2 * ratio / (1 + ratio)};
}

TEST(Slip, IsZeroForARigidMotionOfThePair) {
  Draws draws(61);
  for (const double ratio : size_ratios) {
    for (const double gap : {-0.05, -0.01, -1e-3}) {
      const PairGeometry pair = pair_at(1, ratio, gap, draws.direction());
      const Vector3 spin = draws.direction();
      const Vector3 slip =
          SlidingFriction::stretch_rate(contact_at(pair, ratio), {cross(spin, pair.separation), spin, spin});
      EXPECT_LT(norm(slip), 1e-14 * pair.distance);
    }
  }
}

// Two gears: equal and opposite surface speeds slip, equal ones roll.
TEST(Slip, OfSpinningSpheresIsThatOfTheirSurfaces) {
  const PairGeometry pair = pair_at(1, 2, -1e-9, {1, 0, 0});
  const ContactOf<double> contact = contact_at(pair, 2);
  // At the contact j's surface moves by Omega_j x (-l_j n), i's by Omega_i x l_i n.
  const Vector3 both = SlidingFriction::stretch_rate(contact, {{}, {0, 0, 1}, {0, 0, 1}});
  EXPECT_NEAR(both.y, -3, 1e-8);
  const Vector3 gears = SlidingFriction::stretch_rate(contact, {{}, {0, 0, 2}, {0, 0, -1}});
  EXPECT_NEAR(norm(gears), 0, 1e-8);
}

TEST(Slip, IgnoresTheNormalVelocity) {
  const PairGeometry pair = pair_at(1, 1, -0.01, n);
  EXPECT_EQ(norm(SlidingFriction::stretch_rate(contact_at(pair, 1), {{0, 0, 5}, {}, {}})), 0);
}

TEST(Friction, TorquesBalanceTheForceOfThePair) {
  Draws draws(62);
  for (const double ratio : size_ratios) {
    const PairGeometry pair = pair_at(1, ratio, -0.02, draws.direction());
    const PairLoad load = SlidingFriction::load(contact_at(pair, ratio), across(draws.vector(), pair.normal));
    const Vector3 net = load.torque_first + load.torque_second - cross(pair.separation, load.force);
    EXPECT_LT(norm(net), 1e-13 * norm(load.force));
  }
}

TEST(Friction, DragsTheFirstSphereAlongWithTheSecond) {
  const PairGeometry pair = pair_at(1, 1, -0.01, n);
  const PairMotion motion = {{1, 0, 0}, {}, {}};
  const ContactOf<double> contact = contact_at(pair, 1);
  const Vector3 slip = SlidingFriction::stretch_rate(contact, motion);
  const PairLoad load = SlidingFriction::load(contact, advanced_spring({}, n, 1e-3 * slip, boundless));
  EXPECT_NEAR(load.force.x, 3, 1e-12);  // k_t times the slip, on i along the motion of j
  EXPECT_GT(dissipated(load, motion), 0);
}

TEST(Rolling, GivesACoupleThatOpposesTheDifferenceOfSpins) {
  const PairGeometry pair = pair_at(1, 1.4, -0.01, n);
  const double reduced = 2 * 1.4 / 2.4;
  const PairMotion motion = {{}, {0.3, -0.2, 5}, {-0.1, 0, 2}};
  const ContactOf<double> contact = contact_at(pair, 1.4);
  const PairLoad load = RollingFriction::load(contact, 1e-3 * RollingFriction::stretch_rate(contact, motion));
  EXPECT_EQ(norm(load.force), 0);
  EXPECT_EQ(norm(load.torque_first + load.torque_second), 0);
  // The torque on i is -a^2 k_r times the tangential angle rolled.
  const Vector3 rolled = 1e-3 * across(motion.spin_first - motion.spin_second, n);
  EXPECT_NEAR(norm(load.torque_first + reduced * reduced * 700 * rolled), 0, 1e-12);
  EXPECT_GT(dissipated(load, motion), 0);
}

// Springs enter the matrix as a resistance. With k_t and k_r over one second it gives the loads of springs
// stretched from zero for one second.
TEST(TangentialCoupling, HasTheLoadsOfSpringsThatHaveBeenStretched) {
  Draws draws(63);
  for (const double ratio : size_ratios) {
    const PairGeometry pair = pair_at(1, ratio, -0.02, draws.direction());
    const ContactOf<double> contact = contact_at(pair, ratio);
    const PairMotion motion = {draws.vector(), draws.vector(), draws.vector()};
    const PairLoad slid = SlidingFriction::load(contact, SlidingFriction::stretch_rate(contact, motion));
    const PairLoad rolled = RollingFriction::load(contact, RollingFriction::stretch_rate(contact, motion));
    PairResistance coupling{};
    add_springs(coupling, {.friction = true, .rolling = true}, contact, {.tangential = 1}, {1, 1});
    const PairLoad found = lubrication_load(coupling, pair, motion);
    const double scale = norm(slid.force) + norm(rolled.torque_first);
    EXPECT_LT(norm(found.force - slid.force), 1e-12 * scale);
    EXPECT_LT(norm(found.torque_first - slid.torque_first - rolled.torque_first), 1e-12 * scale);
    EXPECT_LT(norm(found.torque_second - slid.torque_second - rolled.torque_second), 1e-12 * scale);
  }
}

TEST(Spring, TurnsWithTheContactAndKeepsItsLength) {
  Draws draws(63);
  for (int trial = 0; trial < 50; ++trial) {
    const Vector3 before = draws.direction(), after = draws.direction();
    const Vector3 spring = across(draws.vector(), before);
    const Vector3 turned = advanced_spring(spring, after, {}, boundless);
    EXPECT_NEAR(norm(turned), norm(spring), 1e-14);
    EXPECT_NEAR(dot(turned, after), 0, 1e-14);
    // The spring lies along its projection on the new plane.
    EXPECT_NEAR(norm(cross(turned, across(spring, after))), 0, 1e-14);
    EXPECT_GT(dot(turned, spring), 0);
  }
}

TEST(Spring, IsStretchedAfterItWasTurned) {
  const Vector3 spring = advanced_spring({0, 0, 2}, {0, 0.6, 0.8}, {5, 0, 0}, boundless);
  // (0, 0, 2), turned into the plane across (0, 0.6, 0.8), lies along (0, -0.8, 0.6).
  EXPECT_NEAR(norm(spring - Vector3{5, -1.6, 1.2}), 0, 1e-14);
}

TEST(Spring, IsCutToTheLongestThatFrictionBearsAndNeverWindsUp) {
  Vector3 spring;
  for (int step = 0; step < 1000; ++step) {
    spring = advanced_spring(spring, n, {0.01, 0, 0}, 0.05);
    EXPECT_LE(norm(spring), 0.05 * (1 + 1e-15));
  }
  spring = advanced_spring(spring, n, {-0.01, 0, 0}, 0.05);  // unloads at the first step back
  EXPECT_NEAR(spring.x, 0.04, 1e-15);
}

TEST(Spring, VanishesAlongTheNormal) {
  EXPECT_EQ(norm(advanced_spring({0, 0, 3}, n, {}, boundless)), 0);
  EXPECT_EQ(norm(advanced_spring({}, n, {}, boundless)), 0);
}

// One pair with all laws: k_n = 1e4, k_t = 2857, mu = 0.5, k_r = 700, mu_r = 0.2.
class ContactOfTwo : public testing::Test {
 protected:
  static constexpr Terms terms = {.contact = true, .friction = true, .rolling = true};

  TermLoadsOf<double> after_step(double gap, const PairMotion& motion) {
    return loads_of_terms<terms>(pair_parameters(physics_, 1e-3), kind_, pair_at(1, 1, gap, n), motion,
                                 springs_);
  }
  TermLoadsOf<double> after_steps(int steps, double gap, const PairMotion& motion) {
    TermLoadsOf<double> loads;
    for (int step = 0; step < steps; ++step) loads = after_step(gap, motion);
    return loads;
  }

  Physics physics_ = [] {
    Physics physics;
    physics.viscosity = 0.1;
    physics.contact = ContactParameters{.normal_stiffness = 1e4,
                                        .friction = 0.5,
                                        .tangential_stiffness = 2857,
                                        .rolling_stiffness = 700,
                                        .rolling_friction = 0.2};
    return physics;
  }();
  PairKind kind_ = make_pair_kinds(physics_, {1.0}).front();
  PairSpringsOf<double> springs_;
};

TEST_F(ContactOfTwo, SlidesAtTheCoulombForce) {
  for (int step = 0; step < 100; ++step) {
    const TermLoadsOf<double> loads = after_step(-0.01, {{1, 0, 0}, {}, {}});
    EXPECT_LE(norm(loads.springs.tangential.force), 0.5 * norm(loads.contact_normal) * (1 + 1e-14));
  }
  const TermLoadsOf<double> loads = after_step(-0.01, {{1, 0, 0}, {}, {}});
  EXPECT_NEAR(norm(loads.springs.tangential.force), 0.5 * norm(loads.contact_normal), 1e-12);
}

// F_n = 100 and 20, F_CL = 30: the load of friction is 70, then zero.
TEST_F(ContactOfTwo, HasNoFrictionBelowTheCriticalLoad) {
  physics_.contact->critical_load = 30;
  TermLoadsOf<double> loads = after_steps(1000, -0.01, {{1, 0, 0}, {3, 0, 0}, {-3, 0, 0}});
  EXPECT_NEAR(norm(loads.springs.tangential.force), 0.5 * 70, 1e-12);
  EXPECT_NEAR(norm(loads.springs.rolling.torque_first), 0.2 * 70, 1e-12);
  loads = after_step(-0.002, {{1, 0, 0}, {3, 0, 0}, {-3, 0, 0}});
  EXPECT_EQ(norm(loads.springs.tangential.force), 0);
  EXPECT_EQ(norm(loads.springs.rolling.torque_first), 0);
  EXPECT_EQ(norm(springs_.tangential), 0);
  EXPECT_NEAR(norm(loads.contact_normal), 20, 1e-12);
}

TEST_F(ContactOfTwo, HasNoMoreFrictionThanOfTheLargestLoad) {
  physics_.contact->critical_load = 30;
  for (const double largest : {40.0, 80.0}) {
    physics_.contact->largest_load = largest;
    const TermLoadsOf<double> loads = after_steps(1000, -0.01, {{1, 0, 0}, {}, {}});
    EXPECT_NEAR(norm(loads.springs.tangential.force), 0.5 * std::min(largest, 70.0), 1e-12);
  }
}

TEST_F(ContactOfTwo, RollsAtTheLargestCouple) {
  const TermLoadsOf<double> loads = after_steps(1000, -0.01, {{}, {3, 0, 0}, {-3, 0, 0}});
  EXPECT_NEAR(norm(loads.springs.rolling.torque_first), 0.2 * norm(loads.contact_normal), 1e-12);  // a = 1
}

TEST_F(ContactOfTwo, ForgetsWhenItOpens) {
  after_step(-0.01, {{0.3, 0, 0}, {1, 0, 0}, {}});
  EXPECT_GT(norm(springs_.tangential), 0);
  EXPECT_GT(norm(springs_.rolling), 0);
  after_step(0, {{1, 0, 0}, {}, {}});
  EXPECT_EQ(norm(springs_.tangential), 0);
  EXPECT_EQ(norm(springs_.rolling), 0);
  const TermLoadsOf<double> again = after_step(-0.01, {{}, {}, {}});
  EXPECT_EQ(norm(again.springs.tangential.force), 0);
}

TEST_F(ContactOfTwo, IsCutWhenTheNormalForceFalls) {
  after_step(-0.01, {{10, 0, 0}, {}, {}});
  const double before = norm(springs_.tangential);
  after_step(-0.002, {{}, {}, {}});
  EXPECT_LT(norm(springs_.tangential), before);
  EXPECT_NEAR(norm(springs_.tangential), 0.5 * 1e4 * 0.004 * 0.5 / 2857, 1e-15);
}

}  // namespace
}  // namespace peclet::engine
