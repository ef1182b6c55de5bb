// Power balance in shear: the power of the stress equals dissipation plus the rate of storage.
//
// With peculiar velocities c = U - (rate y, 0, 0), spins w = Omega + rate / 2 z, and all forces F and torques
// T of a configuration, at every instant
//   V rate sigma_xy = Phi + dE/dt + sum (zeta c^2 + zeta_r w^2) + sum (F.c + T.w),
//   Phi: dissipation by lubrication, the sum over pairs of v.R.v
//   E: energy of contacts and repulsion
//   sum (zeta c^2 + zeta_r w^2): dissipation by drag
//   sum (F.c + T.w): power of inertia; its long-time mean is that of rate sum m c_x c_y
// The identity ties the symmetrised stress, with each pair once, to forces, torques, images and levers.
#include <gtest/gtest.h>

#include "engine/integrators/spurious_energy.h"
#include "engine/terms/drag.h"
#include "tests/physics/laboratory.h"
#include "tests/physics/reference_resistance.h"

namespace peclet::engine {
namespace {

constexpr double rate = 0.01;  // Stokes number 0.045
constexpr double inner_gap = 1e-2, outer_gap = 0.05;
constexpr double stiffness = 500, repulsion_strength = 1e-3, relative_length = 0.01;

Physics sheared_physics() {
  Physics physics;
  physics.viscosity = natural_viscosity;
  physics.flow = steady_shear(rate);
  physics.contact = ContactParameters{.normal_stiffness = stiffness};
  physics.lubrication = LubricationParameters{inner_gap, outer_gap};
  physics.repulsion = RepulsionParameters{repulsion_strength, relative_length, 20};
  return physics;
}

// Returns forty spheres of radii 1 and 1.4 at a volume fraction of one half, moving with the flow.
Laboratory sheared_suspension(double timestep) {
  Experiment experiment;
  experiment.physics = sheared_physics();
  experiment.radius.assign(28, 1.0);
  experiment.radius.resize(40, 1.4);
  experiment.timestep = timestep;
  set_cube(experiment, 0.5);
  return flowing_suspension(experiment, 9);
}

struct PairPower {
  double dissipated = 0;  // by lubrication
  double stored = 0;      // dE/dt of contacts and repulsion
  double energy = 0;

  PairPower& operator+=(const PairPower& b) {
    return dissipated += b.dissipated, stored += b.stored, energy += b.energy, *this;
  }
};

// Returns the power of one pair from the formulas; r and du of j's image relative to i.
PairPower power_of_pair(const ParticleState& all, std::size_t i, std::size_t j, const Vector3& r,
                        const Vector3& du) {
  const double sum = all.radius[i] + all.radius[j], distance = norm(r), h = distance - sum;
  const double opening = dot(du, r) / distance;
  PairPower power;
  if (h <= 0.5 * outer_gap * sum) {
    const Vector3 wi = all.angular_velocity[i], wj = all.angular_velocity[j];
    Vector12 motion;
    motion << Eigen::Vector3d::Zero(), to_eigen(du), to_eigen(wi), to_eigen(wj);
    power.dissipated = motion.dot(
        reference_resistance(natural_viscosity, all.radius[i], all.radius[j], r, inner_gap) * motion);
  }
  if (h < 0) {
    power.stored += stiffness * h * opening;
    power.energy += 0.5 * stiffness * h * h;
  }
  const double length = relative_length * sum;
  if (h < 20 * length) {
    const double potential = repulsion_strength * std::exp(-h / length);
    power.stored -= potential / length * opening;
    power.energy += potential;
  }
  return power;
}

// Returns the sum over all pairs and images of the lattice (L, 0, 0), (tilt, L, 0), (0, 0, L). An image L
// higher in y is faster by rate L. The engine's neighbour list is not used.
PairPower power_of_all(const System& system) {
  const ParticleState& all = system.particles;
  const double edge = system.box.lengths().x, tilt = system.box.strain() * edge;
  PairPower total;
  for (std::size_t i = 0; i < all.count(); ++i) {
    for (std::size_t j = i + 1; j < all.count(); ++j) {
      const double reach = 1.2 * (all.radius[i] + all.radius[j]);
      const Vector3 r = all.position[j] - all.position[i], u = all.velocity[j] - all.velocity[i];
      for (const double z : {-1., 0., 1.}) {
        for (const double y : {-1., 0., 1.}) {
          // The nearest images in this row.
          const double start = r.x + y * tilt;
          const double x = -std::round(start / edge);
          const Vector3 image = {start + x * edge, r.y + y * edge, r.z + z * edge};
          if (norm(image) < reach) {
            total += power_of_pair(all, i, j, image, {u.x + y * rate * edge, u.y, u.z});
          }
        }
      }
    }
  }
  return total;
}

struct SpherePower {
  double drag = 0, inertia = 0;  // dissipated by drag; m c_x c_y rate
  double kinetic = 0;
};

SpherePower power_of_spheres(const ParticleState& all) {
  SpherePower power;
  for (std::size_t i = 0; i < all.count(); ++i) {
    const Vector3 c = all.velocity[i] - Vector3{rate * all.position[i].y, 0, 0};
    const Vector3 w = all.angular_velocity[i] + Vector3{0, 0, 0.5 * rate};
    const double a = all.radius[i];
    power.drag += a * dot(c, c) + 4.0 / 3 * a * a * a * dot(w, w);  // 6 pi eta = 1
    power.inertia += rate * all.mass[i] * c.x * c.y;
    power.kinetic += 0.5 * (all.mass[i] * dot(c, c) + all.inertia[i] * dot(w, w));
  }
  return power;
}

double sum_of_stress_xy(const PairSums& sums) {
  double xy = 0;
  for (const SymmetricTensor& term : sums.stress) xy += term.xy;
  return xy;
}

// Tolerance: round-off of thousands of products of order one.
TEST(EnergyBalance, HoldsAtEveryInstantOfASheardSuspension) {
  const double timestep = 5e-3;
  Laboratory laboratory = sheared_suspension(timestep);
  for (int moment = 0; moment < 14; ++moment) {
    // After a strain of 0.05: the box flips meanwhile.
    for (int step = 0; step < 1000; ++step) laboratory.step();
    System system = laboratory.system();
    const std::size_t count = system.particles.count();
    ForceField field(laboratory.physics(), system.particles, timestep, /*seed=*/1, /*threads=*/1);
    VectorField force(count), torque(count);
    const PairSums sums = field.evaluate(system, force, torque);
    double taken_up = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Vector3 c = system.particles.velocity[i] - Vector3{rate * system.particles.position[i].y, 0, 0};
      const Vector3 w = system.particles.angular_velocity[i] + Vector3{0, 0, 0.5 * rate};
      taken_up += dot(force[i], c) + dot(torque[i], w);
    }
    const PairPower pairs = power_of_all(system);
    const SpherePower spheres = power_of_spheres(system.particles);
    const double power_in = rate * sum_of_stress_xy(sums);
    EXPECT_GT(pairs.dissipated, 0);
    EXPECT_NEAR(power_in, pairs.dissipated + pairs.stored + spheres.drag + taken_up,
                1e-11 * pairs.dissipated);
  }
  EXPECT_NE(laboratory.system().box.basis(), BasisChange{});
}

// Returns (power in - dissipation - inertia - change of stored energy) / power in, over a window of half a
// strain. The power in is that of the stress reported at each step. Forces see half-step velocities and
// powers here full-step ones, so the imbalance is of first order in the step.
double relative_imbalance(double timestep) {
  Laboratory laboratory = sheared_suspension(timestep);
  const auto steps_of_strain = [&](double strain) { return std::lround(strain / (rate * timestep)); };
  for (long step = steps_of_strain(0.3); step > 0; --step) laboratory.step();
  const auto stored = [&] {
    return power_of_all(laboratory.system()).energy + power_of_spheres(laboratory.particles()).kinetic;
  };
  const double before = stored();
  double in = 0, out = 0;
  for (long step = steps_of_strain(0.5); step > 0; --step) {
    in += timestep * rate * sum_of_stress_xy(laboratory.step().sums);
    const SpherePower spheres = power_of_spheres(laboratory.particles());
    out += timestep * (power_of_all(laboratory.system()).dissipated + spheres.drag + spheres.inertia);
  }
  return (in - out - (stored() - before)) / in;
}

TEST(EnergyBalance, ClosesOverAWindowToFirstOrderInTheStep) {
  const double large = relative_imbalance(6e-3), small = relative_imbalance(3e-3);
  EXPECT_LT(std::abs(large), 5e-4);
  EXPECT_NEAR(large / small, 2, 0.05);
}

// Velocity Verlet in two halves: between the kicks, velocities are those that the forces see.
class StepsTakenApart {
 public:
  StepsTakenApart(const System& system, const Physics& physics, double timestep)
      : system_(system),
        field_(physics, system.particles, timestep, /*seed=*/1, /*threads=*/1),
        force_(system.particles.count()),
        torque_(system.particles.count()),
        timestep_(timestep) {
    system_.springs = SpringField(spring_kinds(field_.terms()), system_.list.pairs().size());
    rebuild_neighbours(system_);
    field_.evaluate(system_, force_, torque_);
  }

  // Steps to the next evaluation of the forces.
  PairSums advance() {
    kick();
    ParticleState& all = system_.particles;
    for (std::size_t i = 0; i < all.count(); ++i) {
      all.position.set(i, all.position[i] + timestep_ * all.velocity[i]);
    }
    ++system_.step;
    system_.box.deform(simple_shear(rate * timestep_ * static_cast<double>(system_.step)));
    if (!system_.list.holds(all, system_.box)) rebuild_neighbours(system_);
    return field_.evaluate(system_, force_, torque_);
  }

  // Completes the step and returns the spurious energy of the step.
  double finish() {
    kick();
    return spurious_energy(system_, field_.kinds(), field_.physics(), force_, torque_, timestep_);
  }

  const System& system() const { return system_; }

 private:
  void kick() {
    ParticleState& all = system_.particles;
    for (std::size_t i = 0; i < all.count(); ++i) {
      all.velocity.set(i, all.velocity[i] + (0.5 * timestep_ / all.mass[i]) * force_[i]);
      all.angular_velocity.set(i, all.angular_velocity[i] + (0.5 * timestep_ / all.inertia[i]) * torque_[i]);
    }
  }

  System system_;
  ForceField field_;
  VectorField force_, torque_;
  double timestep_;
};

constexpr ContactParameters sticking = {.normal_stiffness = 500,
                                        .friction = 100,
                                        .tangential_stiffness = 200,
                                        .rolling_stiffness = 50,
                                        .rolling_friction = 100};

// Two spheres that overlap, slide and roll, without a fluid.
System touching_spheres(const Physics& physics) {
  System system;
  system.particles = make_particles({1, 1.4}, natural_density);
  system.box = PeriodicCell({20, 20, 20}, Matrix3{});
  system.list = NeighbourList(range_table(make_pair_kinds(physics, {1, 1.4}), 2), 0.5);
  system.particles.position.set(0, {5, 5, 5});
  system.particles.position.set(1, {5 + 2.38 * 0.6, 5, 5 + 2.38 * 0.8});
  system.particles.velocity.set(0, {0.1, 0.2, -0.1});
  system.particles.angular_velocity.set(1, {0.2, -0.1, 0.3});
  return system;
}

double kinetic_energy(const ParticleState& all) {
  double sum = 0;
  for (std::size_t i = 0; i < all.count(); ++i) {
    sum += 0.5 * all.mass[i] * dot(all.velocity[i], all.velocity[i]) +
           0.5 * all.inertia[i] * dot(all.angular_velocity[i], all.angular_velocity[i]);
  }
  return sum;
}

double elastic_energy(const System& system) {
  const ParticleState& all = system.particles;
  const double overlap = std::max(0.0, 2.4 - norm(all.position[1] - all.position[0]));
  const ContactSprings springs = system.springs[0];
  return 0.5 * (sticking.normal_stiffness * overlap * overlap +
                sticking.tangential_stiffness * dot(springs.tangential, springs.tangential) +
                sticking.rolling_stiffness * dot(springs.rolling, springs.rolling));
}

// Returns |v_t|^2 at the velocities that the forces saw.
double squared_slip(const ParticleState& all) {
  const Vector3 r = all.position[1] - all.position[0], n = (1 / norm(r)) * r;
  const double half_overlap = 0.5 * (2.4 - norm(r));
  const Vector3 surface =
      (1 - half_overlap) * all.angular_velocity[0] + (1.4 - half_overlap) * all.angular_velocity[1];
  const Vector3 velocity = all.velocity[1] - all.velocity[0] - cross(surface, n);
  return dot(velocity, velocity) - dot(velocity, n) * dot(velocity, n);
}

// A contact that sticks without a dashpot dissipates nothing, nor does one without friction. All other
// changes of energy come from the step. Rough spheres touch all the time; the smooth contact opens.
TEST(EnergyBalance, OfTwoSpheresIsMissedByWhatTheStepsMake) {
  Physics rough, damped, smooth;
  rough.contact = damped.contact = sticking;
  damped.contact->tangential_damping = 5;
  smooth.contact = ContactParameters{.normal_stiffness = sticking.normal_stiffness};
  for (const auto& [physics, count] : {std::pair(rough, 25), std::pair(damped, 25), std::pair(smooth, 50)}) {
    constexpr double timestep = 0.002;
    StepsTakenApart steps(touching_spheres(physics), physics, timestep);
    // The step changes the elastic energy before, and the kinetic energy after its forces are evaluated.
    double elastic = elastic_energy(steps.system()), before = 0, made = 0, largest = 0;
    for (int step = 0; step < count; ++step) {
      steps.advance();
      const double energy = kinetic_energy(steps.system().particles) + elastic;
      before = step == 0 ? energy : before;
      largest = std::max(largest, std::abs(energy - before));
      EXPECT_NEAR(energy - before, made, 1e-3 * largest) << step;
      made -= timestep * physics.contact->tangential_damping * squared_slip(steps.system().particles);
      made += steps.finish();
      elastic = elastic_energy(steps.system());
    }
    EXPECT_EQ(elastic > 0, physics.contact->friction > 0);
    EXPECT_GT(largest, 1e-3 * before);
  }
}

// Half a strain of the suspension above, with every power at the velocities that the forces saw. The
// remaining 2 % are terms of second order in the step, and changes of the flow's own velocity within a step.
TEST(EnergyBalance, OfASuspensionIsMissedByWhatTheStepsMake) {
  const double timestep = 6e-3;
  Laboratory laboratory = sheared_suspension(timestep);
  StepsTakenApart steps(laboratory.system(), laboratory.physics(), timestep);
  const auto state = [&] {
    return power_of_all(steps.system()).energy + power_of_spheres(steps.system().particles).kinetic;
  };
  const long equilibration = std::lround(0.3 / (rate * timestep));
  double before = 0, balance = 0, made = 0;
  for (long step = 0; step < equilibration + std::lround(0.5 / (rate * timestep)); ++step) {
    const PairSums sums = steps.advance();
    if (step == equilibration) {
      before = state();
      balance = made = 0;
    }
    const SpherePower spheres = power_of_spheres(steps.system().particles);
    balance += timestep * (rate * sum_of_stress_xy(sums) - power_of_all(steps.system()).dissipated -
                           spheres.drag - spheres.inertia);
    made += steps.finish();
  }
  steps.advance();
  balance -= state() - before;
  EXPECT_NEAR(-balance, made, 0.05 * made);
}

}  // namespace
}  // namespace peclet::engine
