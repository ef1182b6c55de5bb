#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/flow/waves.h"
#include "engine/integrators/implicit_rules.h"
#include "engine/integrators/midpoint.h"
#include "engine/integrators/noisy_midpoint.h"
#include "engine/integrators/stability.h"
#include "tests/engine/dense_suspension.h"
#include "tests/engine/few_spheres.h"
#include "tests/engine/realisation/small_result.h"

namespace peclet::engine {
namespace {

using std::numbers::pi;

constexpr double tight = 1e-5;
constexpr Vector3 cube_of_20 = {20, 20, 20};

// m (V - V_n) = dt zeta (U - V): velocities relax to the flow's by 1 / (1 + dt zeta / m) a step.
TEST(Implicit, SpheresRelaxToTheStreamingFlow) {
  Physics physics;
  physics.viscosity = 0.1;
  physics.flow = steady_shear(0.01);
  for (const double decay : {0.01, 1.0, 10.0}) {
    System system = spheres_in(cube_of_20, physics, {1.4});
    system.particles.position.set(0, {5, 12, 5});
    system.particles.velocity.set(0, {0.12, 0, 0.01});
    system.particles.angular_velocity.set(0, {0.01, 0, -0.005});
    const double m = 0.1 * 4 * pi / 3 * std::pow(1.4, 3), rate = 6 * pi * 0.1 * 1.4 / m;
    const double spin_rate = 8 * pi * 0.1 * std::pow(1.4, 3) / (0.4 * m * 1.4 * 1.4);
    const double step = decay / rate, first = system.particles.velocity[0].z;
    Midpoint integrator(physics, system.particles, step, tight, 1, 1);
    constexpr int steps = 3;
    start_and_advance(integrator, system, steps);
    const ParticleState& p = system.particles;
    // Each step may leave a residual of `tight`.
    EXPECT_NEAR(p.velocity[0].z / first * std::pow(1 + decay, steps), 1, 10 * tight) << decay;
    EXPECT_NEAR(p.velocity[0].x, 0.12, 1e-6) << decay;
    EXPECT_NEAR(p.angular_velocity[0].x / 0.01 * std::pow(1 + spin_rate * step, steps), 1, 10 * tight)
        << decay;
    EXPECT_NEAR(p.angular_velocity[0].z, -0.005, 1e-7) << decay;
  }
}

// Returns the separation, after `time`, of two spheres of little inertia that start with the flow at rate 1.
Vector3 end_of_pair(Physics physics, const Vector3& first_place, const Vector3& second_place, double time,
                    int steps, double tolerance) {
  physics.viscosity = 0.1;
  if (!physics.flow.varies()) physics.flow = steady_shear(1);
  System system = spheres_in({30, 30, 30}, physics, {1, 1.4}, 1e-6);
  system.particles.position.set(0, first_place);
  system.particles.position.set(1, second_place);
  for (const std::size_t i : {0U, 1U}) {
    system.particles.velocity.set(i, {system.particles.position[i].y, 0, 0});
    system.particles.angular_velocity.set(i, {0, 0, -0.5});
  }
  Midpoint integrator(physics, system.particles, time / steps, tolerance, 1, 1);
  start_and_advance(integrator, system, steps);
  const ParticleState& p = system.particles;
  const std::size_t first = p.id[0] == 0 ? 0 : 1;
  return p.position[1 - first] - p.position[first];
}

// Returns the separation after two spheres pass each other, between inner and outer gap throughout. The error
// is of second order in the step.
Vector3 end_of_encounter(const Physics& physics, int steps) {
  return end_of_pair(physics, {10, 3, 15}, {8.2, 4.9, 15.9}, 1.2, steps, 1e-6);
}

// Expects errors of second order; end(steps) is compared with `exact`, which must be nearer than `range`.
template <class End>
void expect_second_order(const End& end, const Vector3& exact, double range, int steps, double tolerance) {
  ASSERT_LT(norm(exact), range);
  double coarse = norm(end(steps) - exact);
  for (const int factor : {2, 4, 8}) {
    const double fine = norm(end(factor * steps) - exact);
    EXPECT_NEAR(std::log2(coarse / fine), 2, tolerance) << factor * steps;
    coarse = fine;
  }
}

// The second case has strain rates that vary in space.
TEST(Implicit, IsOfSecondOrderForAnEncounter) {
  Physics lubricated, strained;
  lubricated.lubrication = LubricationParameters{1e-3, 0.9};
  strained.lubrication = LubricationParameters{
      .inner_gap = 1e-3, .form = LubricationParameters::Form::mari, .outer_distance = 1.08};
  strained.flow = ImposedFlow(std::make_shared<SteadyShear>(0.7),
                              std::make_shared<Waves>(std::vector<Wave>{{2, 0.5, 0.3}}, true));
  for (const Physics& physics : {lubricated, strained}) {
    const auto end = [&](int steps) { return end_of_encounter(physics, steps); };
    expect_second_order(end, end(960), 2.4 * 1.45, 15, 0.1);  // still within the range
  }
}

// Returns the separation of two spheres that stick while the flow turns and presses them.
Vector3 end_of_contact(int steps) {
  Physics physics;
  physics.contact = ContactParameters{.normal_stiffness = 1e3, .friction = 1, .tangential_stiffness = 300};
  physics.lubrication = LubricationParameters{1e-2, 0.5};
  const Vector3 place = {10, 10, 15}, along = {-1.6, 1.75, 0.2};
  return end_of_pair(physics, place, place + (2.38 / norm(along)) * along, 0.3, steps, 1e-7);
}

// Springs act at 0.6 of their advance; the first-order error of that shows only at smaller steps.
TEST(Implicit, IsNearlyOfSecondOrderForSpheresThatStick) {
  expect_second_order(end_of_contact, end_of_contact(5120), 2.4, 10, 0.15);  // still in contact
}

// A sheared packing with friction: implicit steps give the stress of explicit steps of a five hundredth.
struct Rough {
  double friction;
  bool strained;  // lubrication by strain rates
};
class AgainstExplicit : public testing::TestWithParam<Rough> {
 protected:
  static Json document() {
    Json document = small_scene(
        {{"particles", {{"count", 200}}}, {"integrator", {{"method", "implicit"}, {"timestep", "auto"}}}});
    document["fluid"].erase("thermal_energy");
    document.erase("repulsion");
    document["flow"]["shear_rate"] = 0.045;
    document["lubrication"]["inner_gap"] = 1e-3;
    document["contact"] = {{"normal_stiffness", 1e4}};
    if (GetParam().friction > 0) document["contact"]["friction"] = GetParam().friction;
    if (GetParam().strained) {
      document["lubrication"] = {{"form", "mari"}, {"regularisation", 1e-3}, {"outer_distance", 0.1}};
    }
    document["duration"] = {{"equilibration", {{"strain", 0.05}}}, {"production", {{"strain", 0.2}}}};
    return document;
  }
};
INSTANTIATE_TEST_SUITE_P(Packings, AgainstExplicit,
                         testing::Values(Rough{0, false}, Rough{0.5, false}, Rough{0, true},
                                         Rough{0.5, true}),
                         [](const auto& packing) {
                           return std::string(packing.param.friction > 0 ? "Rough" : "Smooth") +
                                  (packing.param.strained ? "Strained" : "");
                         });
TEST_P(AgainstExplicit, TheStressIsTheSame) {
  Json document = this->document();
  const auto stress = [&](const char* method) {
    document["integrator"]["method"] = method;
    const Scene scene = read_scene(document, "scene.json");
    Simulation simulation = started(scene, 4);
    const Schedule& schedule = simulation.schedule();
    EXPECT_EQ(simulation.advance(schedule.total())->cause, Ending::Cause::completed);
    double sum = 0, steps = 0;
    for (const BlockSums& block : simulation.production().blocks()) {
      for (const SymmetricTensor& term : block.stress) sum += term.xy;
      steps += static_cast<double>(block.steps);
    }
    return sum / steps;
  };
  EXPECT_NEAR(stress("implicit") / stress("explicit"), 1, 0.01);
}

// Returns the mean over all steps of sigma_xy, summed over terms.
double mean_stress(Integrator& integrator, System& system, double time) {
  const auto steps = std::lround(time / integrator.timestep());
  double sum = 0;
  for (long step = 0; step < steps; ++step) {
    const StepReport report = integrator.advance(system);
    EXPECT_LT(report.largest_displacement, 0.05);
    for (const SymmetricTensor& term : report.sums.stress) sum += term.xy;
  }
  return sum / static_cast<double>(steps);
}

// The flow reverses at once: closed contacts open, and the stress changes sign and loses most of its size.
// The contact forces left relax within the first step, which large steps do not resolve.
TEST_P(AgainstExplicit, TheStressAfterAReversalIsTheSame) {
  const Scene scene = read_scene(document(), "scene.json");
  Simulation simulation(scene, {automatic_timestep(scene).value, 0, 1000}, 4, 1, "scene.json");
  simulation.start();
  ASSERT_FALSE(simulation.advance(400));
  System reversed = simulation.system();
  const PeriodicCell& box = reversed.box;
  const double rate = scene.physics.flow.rate();
  reversed.box = PeriodicCell(box.lengths(), simple_shear(-rate), box.tilt());
  reversed.step = 0;
  reversed.clock = {};
  ParticleState& particles = reversed.particles;
  for (std::size_t i = 0; i < particles.count(); ++i) {
    particles.velocity.add(i, {-2 * rate * particles.position[i].y, 0, 0});
    particles.angular_velocity.add(i, {0, 0, rate});
  }
  Physics physics = scene.physics;
  physics.flow = steady_shear(-rate);
  const auto stress = [&](auto& integrator, double time) {
    System system = reversed;
    integrator.start(system);
    return mean_stress(integrator, system, time);
  };
  const double step = automatic_timestep(scene).value;
  for (const auto& [steps, tolerance] : {std::pair{5, 0.05}, std::pair{25, 0.01}}) {
    VelocityVerlet small(ForceField(physics, particles, step / 400, 1, 1), particles, step / 400);
    Midpoint large(physics, particles, step, scene.solver_tolerance, 1, 1);
    const double expected = stress(small, steps * step);
    EXPECT_LT(expected, 0);
    EXPECT_NEAR(stress(large, steps * step) / expected, 1, tolerance) << steps;
  }
}

TEST(Implicit, SaysWhatItsEquationsAreLeftWith) {
  const Physics physics = physics_with({.lubrication = true, .contact = true});
  System system = dense_suspension(physics, 203, 7);
  Midpoint integrator(physics, system.particles, 1e-3, tight, 1, 1);
  integrator.start(system);
  const StepReport report = integrator.advance(system);
  EXPECT_GT(report.solver_iterations, 0);
  EXPECT_GT(report.solver_residual, 0);
  EXPECT_LT(report.solver_residual, 1e-2);
}

// Two spheres are solved exactly, and rounding decides the sign of what is left.
TEST(Implicit, ASquaredResidualBelowZeroIsNoResidual) {
  EXPECT_EQ(relative_residual(0.01, -1e-30, 1), 0);
  EXPECT_DOUBLE_EQ(relative_residual(0.01, 0.25, 4), 0.0025);
  EXPECT_EQ(relative_residual(0.01, 0.25, 0), 0);
  EXPECT_TRUE(std::isnan(relative_residual(0.01, std::nan(""), 1)));
}

TEST(Implicit, StrainAfterNStepsIsNTimesRateAndStep) {
  Physics physics;
  physics.viscosity = 0.1;
  physics.flow = steady_shear(0.7);
  for (const double thermal_energy : {0.0, 1e-6}) {
    physics.thermal_energy = thermal_energy;
    System system = spheres_in(cube_of_20, physics, {1});
    const auto integrator = implicit_steps(physics, system.particles, 0.01, tight, 1, 1);
    integrator->start(system);
    for (int n = 1; n <= 5; ++n) {
      integrator->advance(system);
      EXPECT_NEAR(system.box.strain(), n * 0.7 * 0.01, 1e-15) << n;
    }
  }
}

// Iterations end below the tolerance; smooth packings never reach the limit of iterations.
TEST(Implicit, LeavesNoLargerResidualThanItsTolerance) {
  const Scene scene = scene_from(together({without_friction, Json::parse(R"({
      "particles": {"count": 100}, "fluid": {"thermal_energy": 0}, "repulsion": null,
      "lubrication": {"inner_gap": 1e-3, "outer_gap": 0.5},
      "integrator": {"method": "implicit", "timestep": "auto"}})")}));
  constexpr double tolerance = 1e-3;
  const Simulation simulation = started(scene, 3);
  System system = simulation.system();
  Midpoint integrator(scene.physics, system.particles, automatic_timestep(scene).value, tolerance, 1, 1);
  integrator.start(system);
  for (int step = 0; step < 200; ++step)
    EXPECT_LE(integrator.advance(system).solver_residual, tolerance) << step;
}

// Steps on copies of the system: the steps that it will take, and steps of half the size.
TEST(Implicit, ComparesStepsWithHalfSteps) {
  const Scene scene = scene_from(
      {{"fluid", {{"thermal_energy", 0}}}, {"integrator", {{"method", "implicit"}, {"timestep", "auto"}}}});
  const double step = 4 * automatic_timestep(scene).value;
  Simulation simulation(scene, {step, 200, 200}, 1, 1, "scene.json");
  simulation.start();
  ASSERT_FALSE(simulation.advance(100));
  constexpr int steps = 3;
  const auto stress = [&](int parts) {
    System system = simulation.system();
    Midpoint integrator(scene.physics, system.particles, step / parts, tight, 1, 1);
    integrator.start(system);
    return steps * mean_stress(integrator, system, steps * step);
  };
  System system = simulation.system();
  Midpoint integrator(scene.physics, system.particles, step, tight, 1, 1);
  integrator.start(system);
  const Integrator::HalfSteps found = integrator.compare_half_steps(system, steps);
  const double whole = stress(1), halved = stress(2);
  EXPECT_GT(std::abs(whole / halved - 1), 2e-4);
  EXPECT_NEAR(found.whole / whole, 1, 2e-5);
  EXPECT_NEAR(found.halved / halved, 1, 2e-5);
}

TEST(Implicit, ReportsTheLargestDisplacementRelativeToTheFlow) {
  Physics physics;
  physics.viscosity = 1e-12;
  physics.flow = steady_shear(100);
  for (const double thermal_energy : {0.0, 1e-30}) {
    physics.thermal_energy = thermal_energy;
    System system = spheres_in(cube_of_20, physics, {1, 1});
    system.particles.position.set(0, {5, 15, 5});
    system.particles.velocity.set(0, {1500, 0, 0});  // at rest in the flow
    system.particles.position.set(1, {5, 5, 5});
    system.particles.velocity.set(1, {503, 4, 12});
    const auto integrator = implicit_steps(physics, system.particles, 1e-3, tight, 1, 1);
    integrator->start(system);
    EXPECT_NEAR(integrator->advance(system).largest_displacement, 0.013, 1e-6) << thermal_energy;
  }
}

// Heavy spheres in contact pass each other at constant velocity, far below Coulomb's limit. Their spring
// grows by dt v_t a step, for any number of force evaluations per step. Without noise it acts at 0.6 of its
// advance; the stress is r_x F_z / 2.
TEST(Implicit, StretchesSpringsOnceAStep) {
  Physics physics;
  physics.viscosity = 0.1;
  physics.contact = ContactParameters{.normal_stiffness = 1e3, .friction = 1, .tangential_stiffness = 300};
  physics.lubrication = LubricationParameters{1e-3, 0.05};
  constexpr double step = 1e-3, slip = 0.02;
  constexpr int steps = 4;
  for (const double thermal_energy : {0.0, 1e-30}) {
    physics.thermal_energy = thermal_energy;
    System system = spheres_in(cube_of_20, physics, {1, 1.4}, 1e6);
    system.particles.position.set(0, {10, 10, 10});
    system.particles.position.set(1, {12.39, 10, 10});
    system.particles.velocity.set(1, {0, 0, slip});
    const auto integrator = implicit_steps(physics, system.particles, step, 1e-3, 1, 1);
    integrator->start(system);
    for (int k = 0; k < steps; ++k) {
      const double push = 300 * step * slip * (k + (thermal_energy > 0 ? 1 : 0.6));
      const StepReport report = integrator->advance(system);
      EXPECT_NEAR(report.sums.of(StressTerm::friction).xz / (0.5 * 2.39 * push), 1, 1e-3) << thermal_energy;
    }
    const std::vector<HeldContact> held = held_contacts(system.list, system.particles, system.springs);
    ASSERT_EQ(held.size(), 1u);
    EXPECT_NEAR(held[0].springs.tangential.z / (steps * step * slip), 1, 1e-3) << thermal_energy;
  }
}

}  // namespace
}  // namespace peclet::engine
