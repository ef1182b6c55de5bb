#include "engine/flow/background_flow.h"

#include <gtest/gtest.h>

#include "engine/kernels/instruction_set.h"
#include "engine/state/vector_field.h"
#include "engine/terms/drag.h"
#include "tests/engine/components.h"
#include "tests/engine/draws.h"

namespace peclet::engine {
namespace {

PeriodicCell cell_with(const Matrix3& gradient) { return {{10, 10, 10}, gradient}; }

// Expected: U = (rate y, 0, 0), Omega = (0, 0, -rate / 2), E_xy = rate / 2.
TEST(BackgroundFlow, OfSimpleShearGoesAlongXAndTurnsTheOtherWay) {
  const PeriodicCell cell = cell_with(simple_shear(0.7));
  const BackgroundFlow flow(cell);
  expect_near(flow.velocity({3, 2, 5}), {1.4, 0, 0}, 0);
  expect_near(flow.velocity({3, 2, 5}, 2), {1.4, 0, 0}, 0);
  expect_near(flow.spin({3, 2, 5}), {0, 0, -0.35}, 0);
  expect_near(strain_of(cell.velocity_gradient()), SymmetricTensor{.xy = 0.35}, 0);
}

// u = W x r is a rotation: half its vorticity is W, and the strain rate is zero.
TEST(BackgroundFlow, OfARotationIsThatRotation) {
  Draws draws(1);
  const Vector3 turning = draws.vector();
  const Matrix3 gradient = {cross(turning, Vector3{1, 0, 0}), cross(turning, Vector3{0, 1, 0}),
                            cross(turning, Vector3{0, 0, 1})};
  const PeriodicCell cell = cell_with(gradient);
  const Vector3 place = draws.vector(5);
  expect_near(BackgroundFlow(cell).velocity(place), cross(turning, place), 1e-15);
  expect_near(BackgroundFlow(cell).spin(place), turning, 1e-15);
  expect_near(strain_of(gradient), SymmetricTensor{}, 1e-15);
}

// u = Omega x r + E r for any gradient.
TEST(BackgroundFlow, IsItsRotationAndItsStrain) {
  Draws draws(2);
  for (int n = 0; n < 10; ++n) {
    const PeriodicCell cell = cell_with({draws.vector(), draws.vector(), draws.vector()});
    const BackgroundFlow flow(cell);
    const Vector3 x = draws.vector(5);
    const SymmetricTensor e = strain_of(cell.velocity_gradient());
    const Vector3 strained = {e.xx * x.x + e.xy * x.y + e.xz * x.z, e.xy * x.x + e.yy * x.y + e.yz * x.z,
                              e.xz * x.x + e.yz * x.y + e.zz * x.z};
    expect_near(flow.velocity(x), cross(flow.spin(x), x) + strained, 1e-13);
  }
}

// u'_x = c y^3 has the Laplacian 6 c y; its gradient 3 c y^2 has the Laplacian 6 c.
class Cubic final : public FlowVariation {
 public:
  Local at(const Vector3& x, const PeriodicCell& /*cell*/) const override {
    return {.velocity = {c * x.y * x.y * x.y, 0, 0},
            .laplacian = {6 * c * x.y, 0, 0},
            .gradient = simple_shear(3 * c * x.y * x.y),
            .laplacian_of_gradient = simple_shear(6 * c)};
  }
  double largest_rate(const PeriodicCell& /*cell*/) const override { return 3 * c * 100; }

  static constexpr double c = 0.3;
};

// Corrections: zero for the uniform part, a^2/6 and a^2/10 times the Laplacians for the rest.
TEST(BackgroundFlow, IsFeltByASphereAsFaxenSays) {
  const PeriodicCell cell = cell_with(simple_shear(0.7));
  const Cubic cubic;
  const BackgroundFlow flow(cell, &cubic);
  constexpr double y = 1.3, a = 1.7, c = Cubic::c;
  const Vector3 x = {4, y, 6};
  expect_near(flow.velocity(x), {0.7 * y + c * y * y * y, 0, 0}, 1e-14);
  expect_near(flow.velocity(x, a), {0.7 * y + c * y * (y * y + a * a), 0, 0}, 1e-14);
  expect_near(flow.spin(x), {0, 0, -0.5 * (0.7 + 3 * c * y * y)}, 1e-14);
  EXPECT_NEAR(flow.varying_strain(x, a).xy, 0.5 * (3 * c * y * y + 0.6 * c * a * a), 1e-14);
  EXPECT_EQ(flow.varying_strain(x, a).xx, 0);
}

// 2 eta E of planar extension: eta_E = (xx - yy) / (4 rate) = eta.
TEST(BackgroundFlow, OfExtensionHasTheSolventsNormalStresses) {
  const double rate = 0.3, viscosity = 1.7;
  const SymmetricTensor stress =
      solvent_stress(viscosity, {Vector3{rate, 0, 0}, Vector3{0, -rate, 0}, Vector3{}});
  EXPECT_NEAR((stress.xx - stress.yy) / (4 * rate), viscosity, 1e-15);
  EXPECT_EQ(stress.zz, 0);
  EXPECT_EQ(stress.xy, 0);
}

// The compiled loops give F = zeta (U - u), T = zeta_r (Omega - w), and the speeds relative to U.
TEST(BackgroundFlow, OfAnyGradientDragsTheParticles) {
  Draws draws(3);
  for (const bool sheared : {false, true}) {
    const Matrix3 gradient =
        sheared ? simple_shear(0.4) : Matrix3{draws.vector(), draws.vector(), draws.vector()};
    constexpr std::size_t count = 5;
    VectorField position(count), velocity(count), spin(count), force(count), torque(count);
    for (std::size_t i = 0; i < count; ++i) {
      position.set(i, draws.vector(5));
      velocity.set(i, draws.vector());
      spin.set(i, draws.vector());
    }
    const VectorField place = position;
    const std::vector<std::uint16_t> size_class(count);
    const OneBodyFactors kick{0, 0}, drag{2, 3};
    for (const InstructionSet set : {InstructionSet::baseline, chosen_instruction_set()}) {
      const OneBodyInput in = {.position = position.data(),
                               .velocity = velocity.data(),
                               .spin = spin.data(),
                               .force = force.data(),
                               .torque = torque.data(),
                               .size_class = size_class.data(),
                               .kicks = &kick,
                               .drag = &drag,
                               .flow = plain_flow(gradient)};
      const Speeds speeds = one_body_kernels(set).kick_and_drift(in, 0, count, false, 0);
      one_body_kernels(set).set_drag(in, 0, count);
      double sum = 0, largest = 0;
      for (std::size_t i = 0; i < count; ++i) {
        const Vector3 u = gradient * place[i] - velocity[i];
        sum += dot(u, u);
        largest = std::max(largest, dot(u, u));
        expect_near(force[i], 2 * u, 1e-13);
        const auto& [x, y, z] = gradient.column;
        expect_near(torque[i], 3 * (0.5 * Vector3{y.z - z.y, z.x - x.z, x.y - y.x} - spin[i]), 1e-14);
      }
      EXPECT_NEAR(speeds.sum, sum, 1e-12 * sum);
      EXPECT_NEAR(speeds.largest, largest, 1e-12 * largest);
    }
  }
}

}  // namespace
}  // namespace peclet::engine
