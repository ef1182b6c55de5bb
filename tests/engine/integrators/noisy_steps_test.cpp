// The implicit step with noise, compared with its equations written out for two spheres on a line, and with
// the limit of vanishing temperature.
#include <gtest/gtest.h>

#include <array>
#include <numbers>

#include "engine/integrators/noisy_midpoint.h"
#include "tests/engine/components.h"
#include "tests/engine/few_spheres.h"

namespace peclet::engine {
namespace {

using std::numbers::pi;

// A temperature too small to move anything, which selects the step with noise.
constexpr double cold = 1e-30;
constexpr double very_tight = 1e-6;
constexpr double viscosity = 0.1;
constexpr Vector3 wide = {30, 30, 30};

// Two spheres of radii 1 and 1.4 on a line, the smaller one on the left.
struct OnALine {
  double mass[2], drag[2];
  double inner_gap = 0, outer_gap = 0, stiffness = 0, strength = 0, length = 0;
  bool inertial = false;  // inertia carries the pair across the outer gap

  static constexpr double sum = 2.4;

  // X_A at this gap: Li, Royer & Ness (2023), eq. 9 with beta = 1.4.
  static double squeeze(double gap) {
    const double b = 1.4, cube = std::pow(1 + b, 3);
    return 6 * pi * viscosity *
           (2 * b * b / cube / gap + b * (1 + 7 * b + b * b) / (5 * cube) * std::log(1 / gap));
  }
  bool lubricated(double h) const { return inner_gap > 0 && 2 * h / sum <= outer_gap; }
  // Returns X_A at surface distance h.
  double resistance(double h) const { return lubricated(h) ? squeeze(std::max(2 * h / sum, inner_gap)) : 0; }
  // Returns the part of X_A that jumps to zero at the outer gap; below, the rest on a predicted move from h.
  double jump(double h) const { return lubricated(h) ? squeeze(outer_gap) : 0; }
  double rest_on_the_way(double h, double way) const {
    const double begin = std::max(2 * h / sum, inner_gap);
    const auto root = [&](double made) {
      return std::sqrt(begin * std::max(2 * (h + made) / sum, inner_gap));
    };
    const double e = 1 / (4 * inner_gap), left = (1 / begin + e) / (1 / root(way) + e);
    const double made = way * (0.35 + 0.65 * left);
    const auto continuous = [&](double gap) {
      return squeeze(std::clamp(gap, inner_gap, outer_gap)) - squeeze(outer_gap);
    };
    constexpr int parts = 200'000;
    double average = 0;
    for (int k = 0; k < parts; ++k) average += continuous(2 * (h + made * (k + 0.5) / parts) / sum) / parts;
    return 0.5 * (average + continuous(root(made)));
  }
  // Returns the repulsive force between the spheres; below, its stiffness.
  double push(double h) const {
    return stiffness * std::max(-h, 0.0) + (strength > 0 ? strength / length * std::exp(-h / length) : 0);
  }
  double stiffness_at(double h) const {
    return (h < 0 ? stiffness : 0) +
           (strength > 0 ? strength / (length * length) * std::exp(-h / length) : 0);
  }
};

using Two = std::array<double, 2>;

// One Newton iteration for M (V - V_n) = dt F(x, V), starting from the velocities V. `resistance` acts on V
// and `resistance_to_mean` on the mean of V and V_n, as does the drag of an inertial pair. The push is taken
// at distance `pushed`, and its stiffness counts for dt/2.
Two corrected(const OnALine& pair, const Two& before, const Two& velocity, double resistance,
              double resistance_to_mean, double pushed, double dt) {
  const double part = pair.inertial ? 0.5 : 1;  // share of V in the velocity that the drag acts on
  const auto dragged = [&](std::size_t i) {
    return pair.drag[i] * (part * velocity[i] + (1 - part) * before[i]);
  };
  const double closing = velocity[1] - velocity[0], closing_before = before[1] - before[0];
  const double between =
      resistance * closing + 0.5 * resistance_to_mean * (closing + closing_before) - pair.push(pushed);
  const double link = dt * (resistance + 0.5 * resistance_to_mean + 0.5 * dt * pair.stiffness_at(pushed));
  const double a = pair.mass[0] + part * dt * pair.drag[0] + link;
  const double d = pair.mass[1] + part * dt * pair.drag[1] + link;
  const double p = dt * (between - dragged(0)) - pair.mass[0] * (velocity[0] - before[0]);
  const double q = dt * (-between - dragged(1)) - pair.mass[1] * (velocity[1] - before[1]);
  const double determinant = a * d - link * link;
  return {velocity[0] + (d * p + link * q) / determinant, velocity[1] + (link * p + a * q) / determinant};
}

struct StepOfTwo {
  double lubrication, push;  // stresses r F
  Two velocity;
};

// Predictor: V' from x_n, with the push half a step ahead. Corrector: V from x' = x_n + dt/2 V'. The stress
// comes from the forces that made V, moved to x_n + dt/2 V:
//   - from x_n: half of the jump of the resistance, at V_n
//   - from x': the resistance at V, and the push extrapolated by its stiffness over dt/2 (V - V')
// The correction for the move belongs to lubrication, or to the contact without lubrication.
StepOfTwo step_by_hand(const OnALine& pair, const Two& before, double h, double dt) {
  const double jump = pair.inertial ? pair.jump(h) : 0;
  const Two predicted = corrected(pair, before, before, pair.resistance(h) - jump, jump,
                                  h + 0.5 * dt * (before[1] - before[0]), dt);
  const double way = dt * (predicted[1] - predicted[0]), ahead = h + 0.5 * way;
  const double resistance = pair.inertial ? pair.rest_on_the_way(h, way) : pair.resistance(ahead);
  const Two found = corrected(pair, before, predicted, resistance, jump, ahead, dt);
  const double closing = found[1] - found[0], change = closing - (predicted[1] - predicted[0]);
  const double at_beginning = 0.5 * jump * (before[1] - before[0]);
  const double resisting = (resistance + 0.5 * jump) * closing;
  const double pushing = -pair.push(ahead) + 0.5 * dt * pair.stiffness_at(ahead) * change;
  const double brought = 0.5 * dt * (closing * at_beginning + change * (resisting + pushing)),
               there = OnALine::sum + ahead;
  const double lubrication = (OnALine::sum + h) * at_beginning + there * resisting, push = there * pushing;
  return pair.inner_gap > 0 ? StepOfTwo{lubrication + brought, push, found}
                            : StepOfTwo{lubrication, push + brought, found};
}

struct NamedPair {
  const char* name;
  Physics physics;
  double h, closing, density, timestep;
  bool inertial;
};

// Returns cases in which resistance, stiffness or inertia dominates.
std::vector<NamedPair> pairs_on_a_line() {
  Physics still;
  still.viscosity = viscosity;
  still.thermal_energy = cold;
  std::vector<NamedPair> cases;
  Physics contact = still;
  contact.contact = ContactParameters{.normal_stiffness = 40};
  cases.push_back({"contact", contact, -0.05, -0.3, 0.1, 0.1, false});
  contact.lubrication = LubricationParameters{1e-2, 0.9};
  cases.push_back({"lubricated contact", contact, -0.02, -0.2, 0.1, 0.5, true});
  Physics lubricated = still;
  lubricated.lubrication = LubricationParameters{1e-3, 0.9};
  cases.push_back({"approach", lubricated, 0.2, -0.8, 0.5, 0.3, true});
  cases.push_back({"parting", lubricated, 1.07, 0.15, 1, 0.5, true});
  cases.push_back({"meeting", lubricated, 1.1, -0.15, 1, 0.5, true});
  cases.push_back({"closing the gap", lubricated, 0.03, -0.8, 1, 0.4, true});
  lubricated.repulsion = RepulsionParameters{.strength = 0.3, .relative_length = 0.05, .cutoff_lengths = 20};
  cases.push_back({"repulsion", lubricated, 0.15, -0.6, 0.1, 0.2, true});
  cases.push_back({"parting by repulsion", lubricated, 0.05, 0.1, 1e-3, 0.05, false});
  return cases;
}

OnALine line_of(const NamedPair& given, const ParticleState& particles) {
  OnALine pair{};
  for (const std::size_t i : {0U, 1U}) {
    const double radius = i == 0 ? 1 : 1.4;
    pair.mass[i] = given.density * 4 * pi / 3 * radius * radius * radius;
    pair.drag[i] = 6 * pi * viscosity * radius;
    EXPECT_NEAR(particles.mass[i] / pair.mass[i], 1, 1e-12);
  }
  const Physics& physics = given.physics;
  pair.inner_gap = physics.lubrication ? physics.lubrication->inner_gap : 0;
  pair.outer_gap = physics.lubrication ? physics.lubrication->outer_gap : 0;
  pair.inertial = given.inertial;
  pair.stiffness = physics.contact ? physics.contact->normal_stiffness : 0;
  pair.strength = physics.repulsion ? physics.repulsion->strength : 0;
  pair.length = physics.repulsion ? physics.repulsion->relative_length * OnALine::sum : 0;
  return pair;
}

TEST(NoisyStep, OfTwoSpheresOnALineIsThatOfItsEquations) {
  for (const NamedPair& given : pairs_on_a_line()) {
    System system = spheres_in(wide, given.physics, {1, 1.4}, given.density);
    system.particles.position.set(0, {10, 15, 15});
    system.particles.position.set(1, {10 + OnALine::sum + given.h, 15, 15});
    system.particles.velocity.set(1, {given.closing, 0, 0});
    const OnALine pair = line_of(given, system.particles);
    const StepOfTwo expected = step_by_hand(pair, {0, given.closing}, given.h, given.timestep);
    // The case is sensitive: the two iterations differ, and so do the two distances.
    const double changed = expected.velocity[1] - expected.velocity[0] - given.closing;
    ASSERT_GT(std::abs(changed), 0.05 * std::abs(given.closing)) << given.name;
    const double lightest = std::min(pair.mass[0] / pair.drag[0], pair.mass[1] / pair.drag[1]);
    ASSERT_EQ(given.inertial, pair.inner_gap > 0 && given.timestep <= 4 * lightest) << given.name;

    NoisyMidpoint integrator(given.physics, system.particles, given.timestep, very_tight, 1, 1);
    integrator.start(system);
    const StepReport report = integrator.advance(system);
    const ParticleState& p = system.particles;
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_NEAR(p.velocity[i].x, expected.velocity[p.id[i]], 2e-6 * std::abs(given.closing))
          << given.name << ", sphere " << p.id[i];
    }
    const auto stress = [&](StressTerm term) { return report.sums.of(term).xx; };
    const double scale = std::abs(expected.lubrication) + std::abs(expected.push);
    EXPECT_NEAR(stress(StressTerm::lubrication), expected.lubrication, 2e-5 * scale) << given.name;
    EXPECT_NEAR(stress(StressTerm::contact_normal) + stress(StressTerm::repulsion), expected.push,
                2e-5 * scale)
        << given.name;
  }
}

// The noise force belongs to the resistance at x_n, so the separation in its stress must, too; otherwise the
// mean of the control variate is not zero. F = sqrt(2 kT / dt) (sqrt(X_A) n n + sqrt(Y_A) (1 - n n)) theta,
// eqs. 10 and 22. These spheres pass each other fast, so r F differs by the middle of the step.
TEST(NoisyStep, HasTheStressOfItsNoiseWhereItWasDrawn) {
  Physics physics;
  physics.viscosity = viscosity;
  physics.thermal_energy = 0.02;
  physics.lubrication = LubricationParameters{1e-3, 0.9};
  System system = spheres_in(wide, physics, {1, 1.4}, 10);
  const Vector3 r = {1.5, -1.6, 1.4};  // |r| = 2.6
  system.particles.position.set(0, {10, 15, 15});
  system.particles.position.set(1, Vector3{10, 15, 15} + r);
  system.particles.velocity.set(1, {0.5, 3, -1});
  constexpr double dt = 0.05;
  constexpr std::uint64_t seed = 8, step = 41;
  NoisyMidpoint integrator(physics, system.particles, dt, very_tight, seed, 1);
  integrator.start(system);
  ASSERT_EQ(system.particles.id[0], 0u);
  system.step = step;
  const Vector3 n = (1 / norm(r)) * r;
  OnALine pair{};
  pair.inner_gap = physics.lubrication->inner_gap;
  pair.outer_gap = physics.lubrication->outer_gap;
  const double h = norm(r) - OnALine::sum, b = 1.4;
  const double squeeze = pair.resistance(h);
  const double shear = 6 * pi * viscosity * 4 * b * (2 + b + 2 * b * b) / (15 * std::pow(1 + b, 3)) *
                       std::log(OnALine::sum / (2 * h));
  const Vector3 theta = KeyedRandom(seed, Purpose::pair_noise).normals(step, 0, 1, {}).first;
  const double along = dot(theta, n), c = std::sqrt(2 * physics.thermal_energy / dt);
  const Vector3 force = c * (std::sqrt(squeeze) * along * n + std::sqrt(shear) * (theta - along * n));
  const SymmetricTensor expected = symmetric_dyad(r, force);
  const SymmetricTensor found = integrator.advance(system).sums.of(StressTerm::brownian_lubrication);
  expect_near(found, expected, 1e-9 * norm(r) * norm(force));
}

Vector3 difference(const VectorField& rows, const ParticleState& particles) {
  const std::size_t first = particles.id[0] == 0 ? 0 : 1;
  return rows[1 - first] - rows[first];
}

// Returns the mean of sigma_xy times the volume over `steps` steps.
double mean_stress(Integrator& integrator, System& system, int steps) {
  integrator.start(system);
  double stress = 0;
  for (int k = 0; k < steps; ++k) {
    for (const SymmetricTensor& term : integrator.advance(system).sums.stress) stress += term.xy / steps;
  }
  return stress;
}

// Two interacting spheres that pass each other in shear: within the range of lubrication and above the
// clamped gap, or in contact without lubrication, throughout.
struct Encounter {
  const char* name;
  Physics physics;
  Vector3 first, second;
  double density, time;
  int steps;
};

std::vector<Encounter> encounters() {
  Physics sheared;
  sheared.viscosity = viscosity;
  sheared.flow = steady_shear(1);
  Physics contact = sheared, lubricated = sheared;
  contact.contact = ContactParameters{.normal_stiffness = 5};
  lubricated.lubrication = LubricationParameters{1e-3, 0.9};
  lubricated.repulsion = RepulsionParameters{.strength = 0.2, .relative_length = 0.2, .cutoff_lengths = 20};
  return {{"lubrication and repulsion", lubricated, {10, 3, 15}, {8.2, 4.9, 15.9}, 1e-4, 1.2, 20},
          {"contact", contact, {10, 3, 15}, {8.6, 4.5, 15.9}, 2e-5, 0.4, 5}};
}

// Follows the pair by explicit steps for some time; returns the mean stress.
double followed(const Physics& physics, System& system, double time) {
  // The step is a hundredth of the drag's decay time of the smaller sphere, and a small part of m / X_A.
  const int steps = static_cast<int>(std::lround(time * viscosity * 240 / system.particles.mass[0]));
  VelocityVerlet integrator = explicit_steps(physics, system, time / steps);
  return mean_stress(integrator, system, steps);
}

// Returns the pair with the velocities of its forces; other initial velocities are a first-order error.
System placed(const Encounter& encounter) {
  System system = spheres_in(wide, encounter.physics, {1, 1.4}, encounter.density);
  system.particles.position.set(0, encounter.first);
  system.particles.position.set(1, encounter.second);
  followed(encounter.physics, system, 0.01);
  system.step = 0;
  system.clock = {};
  system.box = PeriodicCell(system.box.lengths(), simple_shear(encounter.physics.flow.rate()));
  return system;
}

// At vanishing temperature the step with noise is of second order in positions, in the stress, and in the
// velocities, which are those of the middle of a step.
TEST(NoisyStep, IsOfSecondOrderWithoutTemperature) {
  for (const Encounter& encounter : encounters()) {
    const System begin = placed(encounter);
    const auto errors = [&](int steps) {
      Physics physics = encounter.physics;
      physics.thermal_energy = cold;
      const double step = encounter.time / steps;
      System found = begin, middle = begin, end = begin;
      NoisyMidpoint integrator(physics, found.particles, step, very_tight, 1, 1);
      const double stress = mean_stress(integrator, found, steps);
      followed(encounter.physics, middle, encounter.time - 0.5 * step);
      const double exact = followed(encounter.physics, end, encounter.time);
      const auto apart = [](const System& a, const System& b, auto field) {
        return norm(difference(a.particles.*field, a.particles) -
                    difference(b.particles.*field, b.particles));
      };
      return std::array<double, 3>{apart(found, end, &ParticleState::position),
                                   apart(found, middle, &ParticleState::velocity), std::abs(stress - exact)};
    };
    const std::array<double, 3> coarse = errors(encounter.steps), fine = errors(2 * encounter.steps);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(std::log2(coarse[k] / fine[k]), 2, 0.2) << encounter.name << ' ' << k;
    }
  }
}

}  // namespace
}  // namespace peclet::engine
