// Kinetic friction below static friction: breaking away, sticking again and forgetting.
#include <gtest/gtest.h>

#include "tests/engine/pair_loads.h"

namespace peclet::engine {
namespace {

// One pair whose surfaces slip along x.
class KineticFrictionOfTwo : public testing::Test {
 protected:
  static constexpr double stiffness = 2857, still = 0.5, kinetic = 0.3;
  static constexpr double load = 100;       // k_n delta
  static constexpr double advance = 2.857;  // force per step at unit slip
  static constexpr Terms terms = {.contact = true, .friction = true, .rolling = true, .kinetic = true};

  // Returns the force along x on the first sphere after a step.
  double after_step(double slip, double gap = -0.01) {
    parameters_.contact = contact_;
    parameters_.spring_timestep = 1e-3;
    const PairGeometry pair = pair_at(1, 1, gap, {0, 0, 1});
    return loads_of_terms<terms>(parameters_, kind_, pair, {{slip, 0, 0}, {}, {}}, springs_)
        .springs.tangential.force.x;
  }
  double after_steps(int steps, double slip, double gap = -0.01) {
    double force = 0;
    for (int step = 0; step < steps; ++step) force = after_step(slip, gap);
    return force;
  }
  bool slides() const { return springs_.slides == 1; }

  ContactParameters contact_ = {.normal_stiffness = 1e4,
                                .friction = still,
                                .kinetic_friction = kinetic,
                                .tangential_stiffness = stiffness,
                                .rolling_stiffness = 700,
                                .rolling_friction = 0.2};
  PairParameters parameters_;
  PairKind kind_ = [this] {
    Physics physics;
    physics.viscosity = 0.1;
    physics.contact = contact_;
    return make_pair_kinds(physics, {1.0}).front();
  }();
  PairSpringsOf<double> springs_;
};

TEST_F(KineticFrictionOfTwo, BreaksAwayAtTheStaticForceAndSlidesAtTheKineticOne) {
  for (int step = 1; step <= 17; ++step) {  // 17 * 2.857 < 50
    EXPECT_NEAR(after_step(1), step * advance, 1e-12);
    EXPECT_FALSE(slides());
  }
  for (int step = 18; step <= 40; ++step) {
    EXPECT_NEAR(after_step(1), kinetic * load, 1e-12);
    EXPECT_TRUE(slides());
  }
}

TEST_F(KineticFrictionOfTwo, SticksAgainWhereItReverses) {
  after_steps(30, 1);
  ASSERT_TRUE(slides());
  EXPECT_NEAR(after_step(-1), kinetic * load - advance, 1e-12);
  EXPECT_FALSE(slides());
  // Holds up to the static force in the other direction: (30 + 50) / 2.857 = 28.001.
  EXPECT_NEAR(after_steps(27, -1), kinetic * load - 28 * advance, 1e-11);
  EXPECT_FALSE(slides());
  EXPECT_NEAR(after_step(-1), -kinetic * load, 1e-12);
  EXPECT_TRUE(slides());
}

// The slip falls, or the load rises, until kinetic friction holds the contact.
TEST_F(KineticFrictionOfTwo, SticksAgainWhereLessHoldsIt) {
  after_steps(30, 1);
  EXPECT_NEAR(after_step(0.01), kinetic * load, 1e-12);
  EXPECT_TRUE(slides());
  EXPECT_NEAR(after_step(0.01, -0.009), 0.9 * kinetic * load, 1e-12);
  EXPECT_TRUE(slides());
  EXPECT_NEAR(after_step(0.01, -0.01), 0.9 * kinetic * load + 0.01 * advance, 1e-12);
  EXPECT_FALSE(slides());
  EXPECT_NEAR(after_steps(8, 1), 0.9 * kinetic * load + 8.01 * advance, 1e-12);  // above the kinetic force
  EXPECT_FALSE(slides());
}

// F_CL = 30: the load of friction is 70, and zero at F_n = 20, where a contact forgets that it slid.
TEST_F(KineticFrictionOfTwo, OfBothKindsGoesByWhatExceedsTheCriticalLoad) {
  contact_.critical_load = 30;
  EXPECT_NEAR(after_steps(12, 1), 12 * advance, 1e-12);  // below 35
  EXPECT_NEAR(after_step(1), kinetic * 70, 1e-12);
  EXPECT_TRUE(slides());
  EXPECT_EQ(after_step(1, -0.002), 0);
  EXPECT_FALSE(slides());
  EXPECT_NEAR(after_steps(12, 1), 12 * advance, 1e-12);
  EXPECT_NEAR(after_step(1), kinetic * 70, 1e-12);
  contact_.largest_load = 40;
  EXPECT_NEAR(after_step(1), kinetic * 40, 1e-12);
}

TEST_F(KineticFrictionOfTwo, MayBeNone) {
  contact_.kinetic_friction = 0;
  EXPECT_NEAR(after_steps(17, 1), 17 * advance, 1e-12);
  for (const double slip : {1.0, 1e-6, -1.0, 1e-12}) {
    EXPECT_EQ(after_step(slip), 0);
    EXPECT_TRUE(slides());
  }
}

TEST_F(KineticFrictionOfTwo, ForgetsThatItSlidWhereItOpens) {
  after_steps(30, 1);
  after_step(1, 0);
  EXPECT_FALSE(slides());
  EXPECT_NEAR(after_steps(17, 1), 17 * advance, 1e-12);
}

// The force within a step is limited by the state of the contact before the step.
TEST_F(KineticFrictionOfTwo, PushesOnTheWayByWhatTheStepBegan) {
  parameters_.felt_share = 0.6;
  EXPECT_NEAR(after_steps(17, 1), 16.6 * advance, 1e-12);
  EXPECT_NEAR(after_step(0.6), 17.36 * advance, 1e-12);  // 17.6 advances exceed 50
  EXPECT_TRUE(slides());
  EXPECT_NEAR(stiffness * springs_.tangential.x, kinetic * load, 1e-12);
  EXPECT_NEAR(after_step(1), kinetic * load, 1e-12);
  // In reverse the contact holds at once, within the step and at its end.
  EXPECT_NEAR(after_step(-1), kinetic * load - 0.6 * advance, 1e-12);
  EXPECT_FALSE(slides());
}

// Shares of a spring that breaks away, and of one held by static friction.
TEST_F(KineticFrictionOfTwo, LeavesItsShareOfTheStiffness) {
  const PairGeometry pair = pair_at(1, 1, -0.01, {0, 0, 1});
  const ContactOf<double> contact = contact_of(contact_, kind_, pair);
  const double longest = still * load / stiffness, left = kinetic * load / stiffness;
  const auto share = [&](double length, double slides) {
    return held_share(Vector3{0.5 * length, 0, 0}, {0, 0, 1}, {0.5 * length, 0, 0},
                      spring_limits<SlidingFriction>(contact, true, slides));
  };
  EXPECT_EQ(share(0.99 * longest, 0), 1);
  EXPECT_NEAR(share(1.01 * longest, 0), left / (1.01 * longest), 1e-14);
  EXPECT_NEAR(share(0.99 * longest, 1), left / (0.99 * longest), 1e-14);
  EXPECT_EQ(share(0.99 * left, 1), 1);
}

}  // namespace
}  // namespace peclet::engine
