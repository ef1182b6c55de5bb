// Power balance in shear with waves: the power of shear and waves is dissipated and stored.
//
// With c = U - (rate y, 0, 0), w = Omega + rate / 2 z, and all forces F and torques T of a configuration. A
// wave u'_x(y) gives a sphere u* = u'(y_i) (1 - a^2 k^2 / 6) and w* = -u''(y_i) / 2 z. At every instant
//   V rate sigma_xy + sum (D.u* + G.w*) = Phi + dE/dt + sum (zeta (c - u*)^2 + zeta_r (w - w*)^2)
//                                         + sum (F.c + T.w),
//   D = zeta (u* - c), G = zeta_r (w* - w): drag
//   Phi: dissipation by lubrication and by the damping of contacts
//   E: energy of contacts, repulsion and attraction
//   sum (F.c + T.w): power of inertia, zero for spheres free of force
// Lubrication has the form kim-karrila, which feels the wave through the drag alone; strained_power_test.cpp
// tests the other form.
#include <gtest/gtest.h>

#include "engine/flow/waves.h"
#include "tests/physics/laboratory.h"
#include "tests/physics/reference_resistance.h"

namespace peclet::engine {
namespace {

constexpr double rate = 0.02, stiffness = 500, damping = 2, inner_gap = 1e-2, outer_gap = 0.1;
constexpr double repulsion = 0.3, debye_length = 0.03;  // force at contact for radius 1
constexpr double hamaker = 0.02, regularisation = 0.02, attraction_range = 0.3;
struct Amplitudes {
  int periods;
  double sine, cosine;
};
constexpr Amplitudes amplitudes[] = {{1, 0.1, 0.05}, {2, -0.06, 0.04}};

Physics wavy_physics() {
  Physics physics;
  physics.viscosity = natural_viscosity;
  std::vector<Wave> waves;
  for (const auto& [periods, sine, cosine] : amplitudes) waves.push_back({periods, sine, cosine});
  physics.flow =
      ImposedFlow(std::make_shared<SteadyShear>(rate), std::make_shared<Waves>(waves, /*faxen=*/true));
  physics.contact = ContactParameters{.normal_stiffness = stiffness, .normal_damping = damping};
  physics.lubrication = LubricationParameters{inner_gap, outer_gap};
  physics.repulsion = RepulsionParameters{.cutoff_lengths = 10,
                                          .form = RepulsionParameters::Form::screened,
                                          .force = repulsion,
                                          .debye_length = debye_length,
                                          .reference_radius = 1};
  physics.attraction = AttractionParameters{hamaker, regularisation, attraction_range};
  return physics;
}

// Returns radii 1, 1.4 and 3 at a volume fraction of one half, moving with the shear.
Laboratory wavy_suspension() {
  Experiment experiment;
  experiment.physics = wavy_physics();
  experiment.radius.assign(40, 1.0);
  experiment.radius.resize(54, 1.4);
  experiment.radius.resize(57, 3.0);
  set_cube(experiment, 0.5, 0.3);
  experiment.timestep = 2e-3;
  return flowing_suspension(experiment, 9);
}

struct PairPower {
  double dissipated = 0, stored = 0;
};

// Returns the power of one pair from the formulas; r and du of j's image relative to i.
PairPower power_of_pair(const ParticleState& all, std::size_t i, std::size_t j, const Vector3& r,
                        const Vector3& du) {
  const double a = all.radius[i], b = all.radius[j], sum = a + b, mean = 2 * a * b / sum;
  const double h = norm(r) - sum, gap = std::max(h, 0.0), opening = dot(du, r) / norm(r);
  PairPower power;
  if (h <= 0.5 * outer_gap * sum) {
    Vector12 motion;
    motion << Eigen::Vector3d::Zero(), to_eigen(du), to_eigen(all.angular_velocity[i]),
        to_eigen(all.angular_velocity[j]);
    power.dissipated = motion.dot(reference_resistance(natural_viscosity, a, b, r, inner_gap) * motion);
  }
  if (h < 0) {
    power.dissipated += damping * opening * opening;
    power.stored += stiffness * h * opening;
  }
  if (h < 10 * debye_length) power.stored -= repulsion * mean * std::exp(-gap / debye_length) * opening;
  if (h < attraction_range) {
    power.stored += hamaker * mean / 12 / (gap * gap + std::pow(regularisation * mean, 2)) * opening;
  }
  return power;
}

// Returns the sums over all pairs and images of the sheared lattice; the engine's neighbour list is not used.
PairPower power_of_all(const System& system) {
  const ParticleState& all = system.particles;
  PairPower total;
  const auto range = [&](std::size_t i, std::size_t j) {
    return all.radius[i] + all.radius[j] + attraction_range;
  };
  for_every_image(system, range, [&](std::size_t i, std::size_t j, const Vector3& r, const Vector3& shift) {
    const Vector3 du = all.velocity[j] - all.velocity[i] + Vector3{rate * shift.y, 0, 0};
    const PairPower power = power_of_pair(all, i, j, r, du);
    total.dissipated += power.dissipated;
    total.stored += power.stored;
  });
  return total;
}

struct SpherePower {
  double by_wave = 0, by_drag = 0, taken_up = 0;
};

SpherePower power_of_spheres(const System& system, const VectorField& force, const VectorField& torque) {
  const ParticleState& all = system.particles;
  const double height = system.box.lengths().y;
  SpherePower power;
  for (std::size_t i = 0; i < all.count(); ++i) {
    const double a = all.radius[i], y = all.position[i].y;
    Vector3 lent, spin;
    for (const auto& [periods, sine, cosine] : amplitudes) {
      const double k = 2 * std::numbers::pi * periods / height;
      lent.x += (1 - a * a * k * k / 6) * (sine * std::sin(k * y) + cosine * std::cos(k * y));
      spin.z -= 0.5 * k * (sine * std::cos(k * y) - cosine * std::sin(k * y));
    }
    const Vector3 c = all.velocity[i] - Vector3{rate * y, 0, 0};
    const Vector3 w = all.angular_velocity[i] + Vector3{0, 0, 0.5 * rate};
    const double zeta = a, zeta_r = 4.0 / 3 * a * a * a;  // 6 pi eta = 1
    power.by_wave += zeta * dot(lent - c, lent) + zeta_r * dot(spin - w, spin);
    power.by_drag += zeta * dot(lent - c, lent - c) + zeta_r * dot(spin - w, spin - w);
    power.taken_up += dot(force[i], c) + dot(torque[i], w);
  }
  return power;
}

// Tolerance: round-off.
TEST(WavePower, IsDissipatedAndStoredAtEveryInstant) {
  Laboratory laboratory = wavy_suspension();
  double stored = 0, by_shear = 0, by_wave = 0, dissipated = 0;
  for (int moment = 0; moment < 8; ++moment) {
    for (int step = 0; step < 500; ++step) laboratory.step();
    System system = laboratory.system();
    const std::size_t count = system.particles.count();
    ForceField field(laboratory.physics(), system.particles, laboratory.timestep(), /*seed=*/1,
                     /*threads=*/1);
    VectorField force(count), torque(count);
    const PairSums sums = field.evaluate(system, force, torque);
    double shear = 0;
    for (const SymmetricTensor& term : sums.stress) shear += rate * term.xy;
    const PairPower pairs = power_of_all(system);
    const SpherePower spheres = power_of_spheres(system, force, torque);
    EXPECT_GT(pairs.dissipated, 0);
    EXPECT_NEAR(shear + spheres.by_wave, pairs.dissipated + pairs.stored + spheres.by_drag + spheres.taken_up,
                1e-10 * (pairs.dissipated + spheres.by_drag));
    stored += std::abs(pairs.stored);
    by_shear += std::abs(shear);
    by_wave += spheres.by_wave;
    dissipated += pairs.dissipated + spheres.by_drag;
  }
  // Every part is large enough that its omission would fail the test.
  for (const double part : {stored, by_shear, by_wave}) EXPECT_GT(part, 1e-2 * dissipated);
}

}  // namespace
}  // namespace peclet::engine
