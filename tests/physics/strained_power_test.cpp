// Power balance of spheres whose lubrication is relative to the flow (form mari).
//
// With peculiar velocities c = U - u(x), spins w = Omega - curl u / 2, and all forces F and torques T of a
// configuration, at every instant and in any flow:
//   sum (zeta c.(c - f) + zeta_r w^2) + sum (F.c + T.w) + sum over pairs (Phi_0 + P_E + P_C) = 0,
//   f = -a^2 k^2 / 6 times a wave at a sphere's centre: Faxen's correction of the drag
//   Phi_0 = m.R.m with the relative motion m = (c_j - c_i, w_i, w_j)
//   P_E: power that the loads of the strain rates take from that motion; P_C: that of contacts
// In a uniform flow, with v = c_j - c_i + (a_i + a_j) E n in the place of c_j - c_i and the stress of the
// pairs:
//   V E:sigma - sum over lubricated pairs h n.E.F = sum (zeta c^2 + zeta_r w^2) + sum (F.c + T.w)
//                                                   + sum over pairs (Phi + dE_contact/dt).
// The term with the surface distance h is the part of r F beyond the stresslets that belong to these strain
// rates by reciprocity. It is of the order of the gap.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "engine/flow/waves.h"
#include "engine/realisation/packing.h"
#include "engine/terms/drag.h"
#include "tests/physics/laboratory.h"
#include "tests/physics/reference_resistance.h"

namespace peclet::engine {
namespace {

constexpr double rate = 0.05, stiffness = 500, regularisation = 1e-2, outer = 0.15;
constexpr Wave wave = {1, 0.1, 0.05};

Physics strained_physics(bool waves) {
  Physics physics;
  physics.viscosity = natural_viscosity;
  physics.flow = steady_shear(rate);
  if (waves) {
    physics.flow = ImposedFlow(std::make_shared<SteadyShear>(rate),
                               std::make_shared<Waves>(std::vector<Wave>{wave}, /*faxen=*/true));
  }
  physics.contact = ContactParameters{.normal_stiffness = stiffness};
  physics.lubrication = LubricationParameters{
      .inner_gap = regularisation, .form = LubricationParameters::Form::mari, .outer_distance = outer};
  return physics;
}

// Returns radii 1, 1.4 and 3 at a volume fraction of one half.
Laboratory strained_suspension(bool waves) {
  Experiment experiment;
  experiment.physics = strained_physics(waves);
  experiment.radius.assign(40, 1.0);
  experiment.radius.resize(54, 1.4);
  experiment.radius.resize(57, 3.0);
  set_cube(experiment, 0.5, 0.3);
  experiment.timestep = 2e-3;
  Laboratory laboratory(experiment);
  ParticleState& all = laboratory.particles();
  place_randomly(all, experiment.box, /*seed=*/9);
  const BackgroundFlow flow = experiment.physics.flow.at(experiment.box);
  for (std::size_t i = 0; i < all.count(); ++i) {
    all.velocity.set(i, flow.velocity(all.position[i]));
    all.angular_velocity.set(i, flow.spin(all.position[i]));
  }
  laboratory.start();
  return laboratory;
}

// The motion of one sphere relative to the flow.
struct Peculiar {
  double radius;
  Vector3 velocity, spin;
  Eigen::Matrix3d strain;  // E at its centre
};

struct PairPower {
  double of_motion = 0;    // Phi_0
  double of_strain = 0;    // P_E
  double together = 0;     // Phi, for one E at both spheres
  double of_contact = 0;   // P_C
  double stored = 0;       // dE_contact/dt
  double of_distance = 0;  // h n.E.F
};

// The functions g of X_G, Y_G, Y_H as published (Monti et al. 2021, A.7), times 6 pi eta. a is the radius of
// the sphere, b the other radius over it, s their sum; `other`: by the strain at the other sphere.
double x_g(double a, double b) { return 2 * a * a * b * b / std::pow(1 + b, 3); }
double x_g_other(double s, double b) { return -2 * s * s * b * b / std::pow(1 + b, 5); }
double y_g(double a, double b) { return a * a / 15 * b * (4 - b + 7 * b * b) / std::pow(1 + b, 3); }
double y_g_other(double s, double b) { return -s * s / 15 * b * (4 - b + 7 * b * b) / std::pow(1 + b, 5); }
double y_h(double a, double b) { return 2 * a * a * a / 15 * b * (2 - b) / std::pow(1 + b, 2); }
double y_h_other(double s, double b) { return s * s * s / 15 * b * b * (1 + 7 * b) / std::pow(1 + b, 5); }

PairPower power_of_pair(const Peculiar& i, const Peculiar& j, const Vector3& r) {
  const double a = i.radius, b = j.radius / a, q = 1 / b, s = i.radius + j.radius, h = norm(r) - s;
  const Eigen::Vector3d n = to_eigen(r).normalized();
  const Eigen::Vector3d du = to_eigen(j.velocity - i.velocity), wi = to_eigen(i.spin), wj = to_eigen(j.spin);
  PairPower power;
  const Eigen::Vector3d contact = h < 0 ? Eigen::Vector3d(stiffness * h * n) : Eigen::Vector3d::Zero();
  power.of_contact = contact.dot(du);
  power.stored = contact.dot(du + i.strain * to_eigen(r));
  if (h > outer) return power;
  const Matrix12 R = reference_relative_resistance(natural_viscosity, i.radius, j.radius, r, regularisation);
  const auto quadratic = [&](const Eigen::Vector3d& v) {
    Vector12 motion;
    motion << Eigen::Vector3d::Zero(), v, wi, wj;
    const Vector12 load = R * motion;
    power.of_distance = h * n.dot(i.strain * load.head<3>()) * -1;
    return motion.dot(load);
  };
  power.of_motion = quadratic(du);
  power.together = quadratic(du + s * i.strain * n);
  const double d = std::max(2 * h / s, 0.0) + regularisation;
  const double X = 6 * std::numbers::pi * natural_viscosity / d;
  const double Y = 6 * std::numbers::pi * natural_viscosity * std::log(1 / d);
  const auto across_n = [&](const Eigen::Matrix3d& E) { return Eigen::Vector3d(E * n - n.dot(E * n) * n); };
  const auto turned = [&](const Eigen::Matrix3d& E) { return Eigen::Vector3d(2 * n.cross(E * n)); };
  const Eigen::Vector3d force =
      X * (x_g(a, b) * n.dot(i.strain * n) - x_g_other(s, q) * n.dot(j.strain * n)) * n +
      2 * Y * (y_g(a, b) * across_n(i.strain) - y_g_other(s, q) * across_n(j.strain));
  const Eigen::Vector3d torque_i = Y * (y_h(a, b) * turned(i.strain) + y_h_other(s, q) * turned(j.strain));
  const Eigen::Vector3d torque_j =
      Y * (y_h_other(s, b) * turned(i.strain) + y_h(j.radius, q) * turned(j.strain));
  power.of_strain = force.dot(du) - torque_i.dot(wi) - torque_j.dot(wj);
  return power;
}

// Returns the sums over all pairs and images of the sheared lattice; the engine's neighbour list is not used.
PairPower power_of_all(const System& system, const std::vector<Peculiar>& spheres) {
  PairPower total;
  const auto range = [&](std::size_t i, std::size_t j) {
    return spheres[i].radius + spheres[j].radius + outer;
  };
  for_every_image(system, range, [&](std::size_t i, std::size_t j, const Vector3& r, const Vector3&) {
    const PairPower power = power_of_pair(spheres[i], spheres[j], r);
    total.of_motion += power.of_motion;
    total.of_strain += power.of_strain;
    total.together += power.together;
    total.of_contact += power.of_contact;
    total.stored += power.stored;
    total.of_distance += power.of_distance;
  });
  return total;
}

Eigen::Matrix3d full(const SymmetricTensor& e) {
  return (Eigen::Matrix3d() << e.xx, e.xy, e.xz, e.xy, e.yy, e.yz, e.xz, e.yz, e.zz).finished();
}

class StrainedPower : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(InShear, StrainedPower, testing::Bool(),
                         [](const auto& waves) { return std::string(waves.param ? "AndWaves" : "Alone"); });

// Tolerance: round-off.
TEST_P(StrainedPower, IsBalancedAtEveryInstant) {
  Laboratory laboratory = strained_suspension(GetParam());
  for (int moment = 0; moment < 8; ++moment) {
    for (int step = 0; step < 500; ++step) laboratory.step();
    System system = laboratory.system();
    const ParticleState& all = system.particles;
    ForceField field(laboratory.physics(), all, laboratory.timestep(), /*seed=*/1, /*threads=*/1);
    VectorField force(all.count()), torque(all.count());
    const PairSums sums = field.evaluate(system, force, torque);
    const BackgroundFlow flow = laboratory.physics().flow.at(system.box);
    std::vector<Peculiar> spheres;
    double drag = 0, taken_up = 0;
    for (std::size_t i = 0; i < all.count(); ++i) {
      const Vector3 x = all.position[i], c = all.velocity[i] - flow.velocity(x);
      const Vector3 w = all.angular_velocity[i] - flow.spin(x);
      const double a = all.radius[i];
      const SymmetricTensor strain = strain_of(simple_shear(rate)) + flow.varying_strain(x, 0);
      spheres.push_back({a, c, w, full(strain)});
      const double k = 2 * std::numbers::pi / system.box.lengths().y;
      const double curved = GetParam() ? wave.sine * std::sin(k * x.y) + wave.cosine * std::cos(k * x.y) : 0;
      const Vector3 faxen = {-a * a * k * k / 6 * curved, 0, 0};
      drag += a * dot(c, c - faxen) + 4.0 / 3 * a * a * a * dot(w, w);  // 6 pi eta = 1
      taken_up += dot(force[i], c) + dot(torque[i], w);
    }
    const PairPower pairs = power_of_all(system, spheres);
    EXPECT_GT(pairs.of_motion, 0);
    EXPECT_NEAR(drag + taken_up + pairs.of_motion + pairs.of_strain + pairs.of_contact, 0,
                1e-10 * (pairs.of_motion + std::abs(pairs.of_strain)));
    if (GetParam()) continue;
    double power_in = 0;
    for (const SymmetricTensor& term : sums.stress) power_in += rate * term.xy;
    EXPECT_NEAR(power_in - pairs.of_distance, drag + taken_up + pairs.together + pairs.stored,
                1e-10 * pairs.together);
    EXPECT_GT(std::abs(pairs.of_distance), 1e-4 * power_in);
  }
}

}  // namespace
}  // namespace peclet::engine
