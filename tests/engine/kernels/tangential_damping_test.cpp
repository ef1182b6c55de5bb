// A dashpot beside the tangential spring of a contact: its force, and Coulomb's limit on the sum of both.
#include <gtest/gtest.h>

#include "tests/engine/pair_loads.h"

namespace peclet::engine {
namespace {

// One pair of k_n = 1e4, k_t = 2857, mu = 0.5 and gamma_t = 20.
class TangentialDampingOfTwo : public testing::Test {
 protected:
  static constexpr double stiffness = 2857, friction = 0.5, damping = 20, step = 1e-3;
  static constexpr double load = 100, limit = friction * load;  // at an overlap of 0.01
  static constexpr Terms sticking = {.contact = true, .friction = true};
  static constexpr Terms sliding = {.contact = true, .friction = true, .kinetic = true};

  PairLoad after_step(const PairGeometry& pair, const PairMotion& motion, double ratio = 1) {
    return remembers_sliding(contact_) ? load_after_step<sliding>(pair, motion, ratio)
                                       : load_after_step<sticking>(pair, motion, ratio);
  }
  // Returns the force along x on the first sphere after a step with slip along x.
  double after_step(double slip, double gap = -0.01) {
    return after_step(pair_at(1, 1, gap, {0, 0, 1}), {{slip, 0, 0}, {}, {}}).force.x;
  }

  ContactParameters contact_ = {.normal_stiffness = 1e4,
                                .friction = friction,
                                .tangential_stiffness = stiffness,
                                .tangential_damping = damping};
  double step_ = step, felt_share_ = 1;
  PairSpringsOf<double> springs_;

 private:
  template <Terms terms>
  PairLoad load_after_step(const PairGeometry& pair, const PairMotion& motion, double ratio) {
    Physics physics;
    physics.viscosity = 0.1;
    physics.contact = contact_;
    PairParameters parameters = pair_parameters(physics, step_);
    parameters.felt_share = felt_share_;
    return loads_of_terms<terms>(parameters, make_pair_kind(physics, 1, ratio), pair, motion, springs_)
        .springs.tangential;
  }
};

TEST_F(TangentialDampingOfTwo, AddsItsForceToThatOfTheSpring) {
  for (int k = 1; k <= 5; ++k) {
    EXPECT_NEAR(after_step(1), k * stiffness * step + damping, 1e-12);
    EXPECT_NEAR(springs_.tangential.x, k * step, 1e-15);
  }
  EXPECT_NEAR(after_step(0), 5 * stiffness * step, 1e-12);
}

// 2.857 k + 20 <= 50 holds up to k = 10. The spring grows up to its own limit.
TEST_F(TangentialDampingOfTwo, IsLimitedTogetherWithTheSpring) {
  for (int k = 1; k <= 17; ++k) {
    EXPECT_NEAR(after_step(1), std::min(k * stiffness * step + damping, limit), 1e-12);
    EXPECT_NEAR(springs_.tangential.x, k * step, 1e-15);
  }
  for (int k = 0; k < 20; ++k) EXPECT_NEAR(after_step(10), limit, 1e-12);
  EXPECT_NEAR(stiffness * springs_.tangential.x, limit, 1e-12);
  EXPECT_NEAR(after_step(-1), limit - stiffness * step - damping, 1e-12);
}

// A new contact has no load, so it slides; the dashpot acts fully as soon as the load allows it.
TEST_F(TangentialDampingOfTwo, PushesWholeAfterAContactHasBegunInMotion) {
  const double small_limit = friction * 1e4 * 1e-5;
  for (int k = 1; k <= 5; ++k) EXPECT_NEAR(after_step(1, -1e-5), small_limit, 1e-12);
  EXPECT_NEAR(after_step(1), small_limit + stiffness * step + damping, 1e-12);
  EXPECT_NEAR(after_step(0), small_limit + stiffness * step, 1e-12);
}

// 2.857 k + 20 > 50 at k = 11. The contact sticks again when the sum is at most 30.
TEST_F(TangentialDampingOfTwo, SlidesAndSticksByBothTogether) {
  contact_.kinetic_friction = 0.3;
  for (int k = 1; k <= 10; ++k) {
    EXPECT_NEAR(after_step(1), k * stiffness * step + damping, 1e-12);
    EXPECT_EQ(springs_.slides, 0);
  }
  for (int k = 11; k <= 20; ++k) {
    EXPECT_NEAR(after_step(1), 0.3 * load, 1e-12);
    EXPECT_EQ(springs_.slides, 1);
    EXPECT_NEAR(stiffness * springs_.tangential.x, 0.3 * load, 1e-12);
  }
  EXPECT_NEAR(after_step(-1), 0.3 * load - stiffness * step - damping, 1e-12);
  EXPECT_EQ(springs_.slides, 0);
  springs_ = {};
  EXPECT_NEAR(after_step(10), 0.3 * load, 1e-12);  // 28.57 + 200; the spring is shorter than 30
  EXPECT_EQ(springs_.slides, 1);
  EXPECT_NEAR(stiffness * springs_.tangential.x, 10 * stiffness * step, 1e-12);
}

TEST_F(TangentialDampingOfTwo, PushesWholeWhereTheSpringPushesInPart) {
  felt_share_ = 0.6;
  EXPECT_NEAR(after_step(1), 0.6 * stiffness * step + damping, 1e-12);
  EXPECT_NEAR(after_step(1), 1.6 * stiffness * step + damping, 1e-12);
}

// Without a spring F = gamma_t v_t and T = l n x F, and the torques balance.
TEST_F(TangentialDampingOfTwo, HasBalancedTorquesAndDissipates) {
  contact_.friction = 1e6;
  step_ = 0;
  Draws draws(64);
  for (const double ratio : size_ratios) {
    const PairGeometry pair = pair_at(1, ratio, -0.02, draws.direction());
    const PairMotion motion = random_motion(draws);
    const PairLoad found = after_step(pair, motion, ratio);
    const ContactLevers lever = contact_levers(1, ratio, pair);
    const Vector3 spin = lever.first * motion.spin_first + lever.second * motion.spin_second;
    const Vector3 slip = across(motion.velocity, pair.normal) - cross(spin, pair.normal);
    EXPECT_LT(norm(found.force - damping * slip), 1e-12 * norm(found.force));
    EXPECT_LT(norm(found.torque_first - lever.first * cross(pair.normal, found.force)),
              1e-12 * norm(found.force));
    EXPECT_LT(norm(found.torque_first + found.torque_second - cross(pair.separation, found.force)),
              1e-12 * norm(found.force));
    EXPECT_NEAR(dissipated(found, motion), damping * dot(slip, slip), 1e-11 * damping * dot(slip, slip));
  }
}

TEST_F(TangentialDampingOfTwo, FeelsNoRigidRotation) {
  Draws draws(65);
  for (const double ratio : size_ratios) {
    const PairGeometry pair = pair_at(1, ratio, -0.02, draws.direction());
    const Vector3 spin = draws.vector();
    const PairLoad found = after_step(pair, {cross(spin, pair.separation), spin, spin}, ratio);
    EXPECT_LT(norm(found.force), 1e-12 * damping);
  }
}

// Random slips of 1e-3 to 1e3 times mu N / gamma_t: a step never stores more energy than is put in.
TEST_F(TangentialDampingOfTwo, DissipatesWhateverTheMotion) {
  Draws draws(66);
  const PairGeometry pair = pair_at(1, 1, -0.01, {0, 0, 1});
  const auto stored = [&] { return 0.5 * stiffness * dot(springs_.tangential, springs_.tangential); };
  for (const double kinetic : {ContactParameters{}.kinetic_friction, 0.3}) {
    contact_.kinetic_friction = kinetic;
    for (int k = 0; k < 2000; ++k) {
      const double size = limit / damping * std::pow(10, draws.uniform(-3, 3));
      const Vector3 slip = size * across(draws.direction(), pair.normal);
      const double before = stored();
      const Vector3 force = after_step(pair, {slip, {}, {}}).force;
      EXPECT_LE(norm(force), limit * (1 + 1e-14));
      EXPECT_GE(step * dot(force, slip) - (stored() - before), -1e-12) << k;
    }
  }
}

// A sticking contact has the stiffness k_t dt + gamma_t, a sliding one the share that is not cut.
TEST_F(TangentialDampingOfTwo, CouplesAsTheChangeOfItsForce) {
  const PairGeometry pair = pair_at(1, 1, -0.01, {0, 0, 1});
  const ContactOf<double> contact = {contact_, pair, contact_levers(1, 1, pair), 1};
  for (const double slip : {1.0, 5.0}) {
    PairResistance coupling{};
    add_springs(coupling, sticking, contact, {.resistance = 1, .tangential = step},
                held_shares(sticking, contact, {{slip, 0, 0}, {}, {}}, step, PairSpringsOf<double>{}));
    springs_ = {};
    EXPECT_NEAR(coupling.shear * slip, after_step(slip), 1e-12);
  }
}

}  // namespace
}  // namespace peclet::engine
