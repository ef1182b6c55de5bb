// The momentum flux that steps report, compared with the momentum that particles gain.
//
// For spheres away from the faces of the cell, sum m x V changes in a step dt by
//   dt [sum x F_body + sum m V V'] + (sum over pairs of forces at distances), so that
//   V J = sum sym(x F_body) - (change of sum m sym(x V)) / dt.
// Pair forces do not appear on the right. x is x_n for the noise, and the midpoint of the displacement for
// the drag on a velocity: there x F_body has no mean from correlations within the step.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/kernels/pair_pass.h"
#include "tests/engine/available_sets.h"
#include "tests/engine/components.h"
#include "tests/engine/draws.h"
#include "tests/engine/few_spheres.h"

namespace peclet::engine {
namespace {

constexpr double fluid_viscosity = 0.1, fluid_energy = 0.02, usual_density = 0.1;
constexpr std::uint64_t noise_seed = 5;
constexpr std::size_t sphere_count = 27;

Physics cluster_physics() {
  Physics physics;
  physics.viscosity = fluid_viscosity;
  physics.thermal_energy = fluid_energy;
  physics.contact = ContactParameters{.normal_stiffness = 1e3};
  physics.lubrication = LubricationParameters{1e-3, 0.05};
  physics.repulsion = RepulsionParameters{.strength = 0.3, .relative_length = 0.02, .cutoff_lengths = 10};
  return physics;
}

// Returns spheres on a slightly disturbed grid, with contacts and gaps.
System cluster(const Physics& physics, double density) {
  std::vector<double> radius(sphere_count);
  for (std::size_t i = 0; i < sphere_count; ++i) radius[i] = i % 2 == 0 ? 1 : 1.4;
  System system = spheres_in({40, 40, 40}, physics, radius, density);
  Draws draws(3);
  for (std::size_t i = 0; i < sphere_count; ++i) {
    const std::size_t column = i % 3, row = i / 3 % 3, layer = i / 9;
    const Vector3 place = {static_cast<double>(column), static_cast<double>(row), static_cast<double>(layer)};
    system.particles.position.set(i, Vector3{17, 17, 17} + 2.42 * place + draws.vector(0.03));
    system.particles.velocity.set(i, draws.vector(0.1));
    system.particles.angular_velocity.set(i, draws.vector(0.1));
  }
  return system;
}

// Positions and velocities by particle id.
struct Motion {
  std::vector<Vector3> position, velocity;
};
Motion motion_of(const System& system) {
  Motion motion{std::vector<Vector3>(sphere_count), std::vector<Vector3>(sphere_count)};
  for (std::size_t i = 0; i < sphere_count; ++i) {
    motion.position[system.particles.id[i]] = system.particles.position[i];
    motion.velocity[system.particles.id[i]] = system.particles.velocity[i];
  }
  return motion;
}

double mass_of(std::size_t id, double density) {
  return density * 4 * std::numbers::pi / 3 * std::pow(id % 2 == 0 ? 1 : 1.4, 3);
}
double drag_of(std::size_t id) { return 6 * std::numbers::pi * fluid_viscosity * (id % 2 == 0 ? 1 : 1.4); }

struct Step {
  double dt, density;
  bool inertial;  // the drag acts on (V_n + V)/2; otherwise on V
};

// Returns the right-hand side above.
SymmetricTensor gained(const Motion& before, const Motion& after, std::uint64_t name, const Step& step) {
  const double dt = step.dt;
  const KeyedRandom noise(noise_seed, Purpose::one_body_noise);
  SymmetricTensor flux;
  for (std::uint32_t i = 0; i < sphere_count; ++i) {
    const Vector3 &x = before.position[i], &u = before.velocity[i], &v = after.velocity[i];
    flux += symmetric_dyad(x, std::sqrt(2 * fluid_energy * drag_of(i) / dt) * noise.normals(name, i).first);
    const double share = step.inertial ? 0.5 : 1;
    flux += -share * drag_of(i) * symmetric_dyad(x + (0.5 * dt) * v, v);
    flux += -(1 - share) * drag_of(i) * symmetric_dyad(x - (0.5 * dt) * u, u);
    flux += (-mass_of(i, step.density) / dt) * symmetric_dyad(after.position[i], v);
    flux += (mass_of(i, step.density) / dt) * symmetric_dyad(x, u);
  }
  return flux;
}

double largest_difference(const SymmetricTensor& a, const SymmetricTensor& b) {
  double largest = 0;
  for (const auto part : every_component) largest = std::max(largest, std::abs(a.*part - b.*part));
  return largest;
}

SymmetricTensor acted(const StepReport& report) { return total_stress(report.sums) + report.motion; }

// Tolerance of the solver's single-precision rows and residual.
constexpr double of_single_precision = 2e-4;

struct NamedPhysics {
  const char* name;
  Physics physics;
};

std::vector<NamedPhysics> kinds_of_pairs() {
  Physics rough = cluster_physics(), attracted = cluster_physics(), strained = cluster_physics(),
          dry = cluster_physics();
  rough.contact->friction = 0.5;
  rough.contact->tangential_stiffness = 300;
  rough.contact->rolling_stiffness = 100;
  rough.contact->rolling_friction = 0.2;
  rough.contact->normal_damping = 0.5;
  attracted.attraction = AttractionParameters{.hamaker = 1e-3, .regularisation = 0.01, .cutoff = 0.5};
  strained.lubrication = LubricationParameters{
      .inner_gap = 1e-3, .outer_gap = 0, .form = LubricationParameters::Form::mari, .outer_distance = 0.05};
  dry.lubrication.reset();
  return {{"plain", cluster_physics()},
          {"rough", rough},
          {"attracted", attracted},
          {"strained", strained},
          {"dry", dry}};
}

// Returns the number of contacts, summed over all steps.
double expect_what_particles_gain(const NamedPhysics& kind, const Step& how, InstructionSet set) {
  const double dt = how.dt;
  const Physics& physics = kind.physics;
  const std::string where = fmt::format("{}, step {}, set {}", kind.name, dt, static_cast<int>(set));
  System system = cluster(physics, how.density);
  const auto integrator = implicit_steps(physics, system.particles, dt, 1e-7, noise_seed, 1, set);
  integrator->start(system);
  double contacts = 0;
  for (int step = 0; step < 20; ++step) {
    const Motion before = motion_of(system);
    const std::uint64_t name = system.step;
    const StepReport report = integrator->advance(system);
    EXPECT_FALSE(report.broke_off) << where;
    const SymmetricTensor expected = gained(before, motion_of(system), name, how);
    const double tolerance = of_single_precision * (1 + std::abs(expected.xx));
    EXPECT_LT(largest_difference(acted(report), expected), tolerance) << where;
    contacts += report.sums.contacts;
  }
  return contacts;
}

// Two steps in which inertia carries pairs across the outer gap, and one longer than four times m / drag of a
// small sphere, which is 0.22 or 0.011.
TEST(MomentumFlux, OfImplicitStepsIsWhatParticlesGain) {
  for (const InstructionSet set : available_sets()) {
    for (const NamedPhysics& kind : kinds_of_pairs()) {
      for (const Step& how :
           {Step{0.002, usual_density, true}, {0.02, usual_density, true}, {0.1, 0.005, false}}) {
        const bool is_inertial = how.inertial && kind.physics.lubrication.has_value();
        const double contacts = expect_what_particles_gain(kind, {how.dt, how.density, is_inertial}, set);
        // Without lubrication the spheres fly apart in long steps.
        if (kind.physics.lubrication || how.dt < 0.01) {
          EXPECT_GT(contacts, 20) << kind.name << ", step " << how.dt;
        }
      }
    }
  }
}

// A sphere moving at u' from x_n to x_n+1 carries m u' u' minus half a step of the drag on u', taken at the
// midpoint. Pair forces act at the current positions.
TEST(MomentumFlux, OfVelocityVerletIsTheStressAndTheMotion) {
  const Physics physics = cluster_physics();
  System system = cluster(physics, usual_density);
  constexpr double dt = 1e-4;
  VelocityVerlet integrator = explicit_steps(physics, system, dt, noise_seed);
  integrator.start(system);
  for (int step = 0; step < 5; ++step) {
    const Motion before = motion_of(system);
    const StepReport report = integrator.advance(system);
    const Motion after = motion_of(system);
    SymmetricTensor expected;
    for (const SymmetricTensor& part : report.sums.stress) expected += part;
    for (std::size_t i = 0; i < sphere_count; ++i) {
      const Vector3 u = (1 / dt) * (after.position[i] - before.position[i]);
      expected += (0.5 * dt * drag_of(i) - mass_of(i, usual_density)) * symmetric_dyad(u, u);
    }
    EXPECT_LT(largest_difference(acted(report), expected), 1e-9 * (1 + std::abs(expected.xx)));
  }
}

// Conservative parts are even and dissipative parts odd in the velocities.
TEST(MomentumFlux, HasConservativeAndDissipativeParts) {
  const Physics physics = cluster_physics();
  System system = cluster(physics, usual_density);
  constexpr double dt = 1e-4;
  VelocityVerlet integrator = explicit_steps(physics, system, dt, noise_seed);
  integrator.start(system);
  const StepReport report = integrator.advance(system);
  const MomentumFlux flux = flux_of(report.sums, report.motion);
  const auto of = [&](StressTerm term) { return report.sums.of(term).xy; };
  EXPECT_NE(of(StressTerm::lubrication), 0);
  EXPECT_EQ(flux.dissipative.xy, of(StressTerm::lubrication));
  const double even = report.motion.xy + of(StressTerm::contact_normal) + of(StressTerm::repulsion);
  EXPECT_NE(report.motion.xy, 0);
  EXPECT_NEAR(flux.conservative.xy, even, 1e-12);
  EXPECT_NEAR(flux.acted().xy, even + of(StressTerm::lubrication) + of(StressTerm::brownian_lubrication),
              1e-12);
}

// The sums of the pairs shown to a watcher.
class Shown final : public PairWatcher {
 public:
  void begin(const System& /*system*/, double /*weight*/) override {}
  void take(const System& /*system*/, const Pair& /*pair*/, const PairSums& sums,
            const Vector3& /*force*/) override {
    for (std::size_t t = 0; t < count_of_stress_terms; ++t) by_term[t] += sums.stress[t];
  }
  void take_motion(const System& /*system*/, std::size_t /*particle*/,
                   const SymmetricTensor& stress) override {
    motion += stress;
  }

  std::array<SymmetricTensor, count_of_stress_terms> by_term{};
  SymmetricTensor motion;
};

// The stresses shown pair by pair add up to the reported stress, term by term.
TEST(MomentumFlux, IsThatOfThePairsThatAreShown) {
  Physics physics = cluster_physics();
  physics.contact->friction = 0.5;
  physics.contact->tangential_stiffness = 300;
  physics.attraction = AttractionParameters{.hamaker = 1e-3, .regularisation = 0.01, .cutoff = 0.5};
  for (const Step& how : {Step{0.002, usual_density, true}, {0.1, 0.005, false}}) {
    System system = cluster(physics, how.density);
    const auto integrator = implicit_steps(physics, system.particles, how.dt, 1e-7, noise_seed, 1);
    integrator->start(system);
    for (int step = 0; step < 3; ++step) {
      Shown shown;
      integrator->show_pairs_to(&shown);
      const StepReport report = integrator->advance(system);
      ASSERT_FALSE(report.broke_off);
      const SymmetricTensor whole = total_stress(report.sums);
      const double scale = 1 + std::abs(whole.xx) + std::abs(whole.xy);
      for (std::size_t t = 0; t < count_of_stress_terms; ++t) {
        EXPECT_LT(largest_difference(shown.by_term[t], report.sums.stress[t]), 1e-8 * scale)
            << how.dt << ' ' << name_of(static_cast<StressTerm>(t));
      }
      EXPECT_LT(largest_difference(shown.motion, report.motion), 1e-12 * scale);
    }
  }
}

}  // namespace
}  // namespace peclet::engine
