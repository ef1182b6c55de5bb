// The effect of the step on the stress, also beyond the largest step that a scene may have.
//
// A suspension of Table 4.1 of Li (2023) at rate 0.045 without noise follows a reference at a small step.
// Windows of strain start from states of the reference and are run at larger steps, without regard to the
// stability check. Differences between stresses of a window come from the step until chaos separates the
// runs. Prints one JSON object per window and step; results/timestep-gate has the table.
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>

#include "engine/integrators/velocity_verlet.h"
#include "engine/realisation/packing.h"

namespace {

using namespace peclet::engine;

constexpr double rate = 0.045, viscosity = 0.1, density = 0.1;
constexpr double reference_step = 5e-5, equilibration_step = 1.5e-4;
constexpr double steps_to_try[] = {reference_step, 1e-4, 2e-4, 3e-4, 3.2e-4, 3.4e-4,
                                   3.6e-4,         4e-4, 5e-4, 7e-4, 1e-3};
constexpr double equilibration_strain = 1, window_strain = 0.3;
constexpr double settling_strain = 0.02;  // not measured: runs adjust to their step

// The default guards of a realisation (engine/realisation/simulation.cpp).
constexpr long stability_check_interval = 5000, energy_sampling_interval = 500;
constexpr double largest_overlap = 0.05, largest_displacement = 0.05;

struct Arguments {
  double volume_fraction, friction;
  std::uint64_t seed;
  std::size_t count;
  int windows;
};

struct Outcome {
  System end;
  const char* ending = "completed";
  double lubrication = 0, contact = 0;  // xy over viscosity * rate
  double contacts_per_particle = 0;
  double stability_share = 0, energy_imbalance = 0;
  double largest_overlap = 0;
  double seconds = 0;
};

Physics physics_of(const Arguments& arguments) {
  Physics physics;
  physics.viscosity = viscosity;
  physics.flow = steady_shear(rate);
  physics.contact = ContactParameters{
      .normal_stiffness = 1e4, .friction = arguments.friction, .tangential_stiffness = 2.0 / 7.0 * 1e4};
  physics.lubrication = LubricationParameters{.inner_gap = 1e-3, .outer_gap = 0.05};
  return physics;
}

System packed(const Arguments& arguments) {
  Particles particles;
  particles.count = arguments.count;
  particles.species = {{1.0, 0.5}, {1.4, 0.5}};
  const std::vector<double> radius = species_radii(particles), sizes = distinct_radii(radius);
  const double edge = cube_edge(radius, arguments.volume_fraction);
  System system;
  system.particles = make_particles(radius, density);
  system.box = PeriodicCell({edge, edge, edge}, simple_shear(rate));
  system.list = NeighbourList(range_table(make_pair_kinds(physics_of(arguments), sizes), sizes.size()), 0.03);
  place_randomly(system.particles, system.box, arguments.seed);
  for (std::size_t i = 0; i < radius.size(); ++i) {
    system.particles.velocity.set(i, {rate * system.particles.position[i].y, 0, 0});
    system.particles.angular_velocity.set(i, {0, 0, -0.5 * rate});
  }
  return system;
}

long steps_of(double strain, double step) { return std::lround(strain / (rate * step)); }

// Stress and energy of the measured part of a window.
class Sums {
 public:
  void add(const StepReport& report) {
    const auto xy = [&](StressTerm term) { return report.sums.stress[static_cast<std::size_t>(term)].xy; };
    lubrication_ += xy(StressTerm::lubrication);
    contact_ += xy(StressTerm::contact_normal) + xy(StressTerm::friction);
    contacts_ += static_cast<double>(report.sums.contacts);
    ++steps_;
  }
  void add_energy(double spurious) {
    energy_ += spurious;
    ++samples_;
  }

  void reduce(const System& system, double step, Outcome& outcome) const {
    const double volume = system.box.volume(), unit = viscosity * rate;
    outcome.lubrication = lubrication_ / steps_ / (volume * unit);
    outcome.contact = contact_ / steps_ / (volume * unit);
    outcome.contacts_per_particle = 2 * contacts_ / steps_ / static_cast<double>(system.particles.count());
    outcome.energy_imbalance = energy_ / samples_ / (step * rate * (lubrication_ + contact_) / steps_);
  }

 private:
  double lubrication_ = 0, contact_ = 0, contacts_ = 0, energy_ = 0;
  double steps_ = 0, samples_ = 0;
};

Outcome run(System system, const Physics& physics, double step, double strain) {
  const auto begin = std::chrono::steady_clock::now();
  Outcome outcome;
  VelocityVerlet integrator(ForceField(physics, system.particles, step, /*seed=*/0, /*threads=*/1),
                            system.particles, step);
  integrator.start(system);
  Sums sums;
  for (long k = 0; k < steps_of(strain, step); ++k) {
    if (k % stability_check_interval == 0) {
      outcome.stability_share = std::max(outcome.stability_share, integrator.stability_share(system));
    }
    const StepReport report = integrator.advance(system);
    outcome.largest_overlap = std::max(outcome.largest_overlap, report.sums.largest_overlap);
    if (!(report.largest_displacement < largest_displacement)) {
      outcome.ending = "displacement";
      break;
    }
    if (report.sums.largest_overlap > largest_overlap) {
      outcome.ending = "overlap";
      break;
    }
    if (k >= steps_of(settling_strain, step)) {
      sums.add(report);
      if (k % energy_sampling_interval == 0) sums.add_energy(integrator.spurious_energy(system).value());
    }
  }
  sums.reduce(system, step, outcome);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  outcome.seconds = seconds.count();
  outcome.end = std::move(system);
  return outcome;
}

void print(const Arguments& arguments, int window, double step, const Outcome& outcome) {
  const auto number = [](double value) {
    return std::isfinite(value) ? fmt::format("{:.6g}", value) : "null";
  };
  fmt::print(
      R"({{"volume_fraction": {}, "friction": {}, "seed": {}, "count": {}, "window": {}, )"
      R"("timestep": {}, "ending": "{}", "lubrication": {}, "contact": {}, )"
      R"("contacts_per_particle": {}, "stability_share": {}, "energy_imbalance": {}, "largest_overlap": {}, "seconds": {:.1f}}})"
      "\n",
      arguments.volume_fraction, arguments.friction, arguments.seed, arguments.count, window, step,
      outcome.ending, number(outcome.lubrication), number(outcome.contact),
      number(outcome.contacts_per_particle), number(outcome.stability_share),
      number(outcome.energy_imbalance), number(outcome.largest_overlap), outcome.seconds);
  std::fflush(stdout);
}

void study(const Arguments& arguments) {
  const Physics physics = physics_of(arguments);
  Outcome reference = run(packed(arguments), physics, equilibration_step, equilibration_strain);
  if (std::string(reference.ending) != "completed") {
    print(arguments, -1, equilibration_step, reference);
    return;
  }
  for (int window = 0; window < arguments.windows; ++window) {
    const System start = reference.end;
    for (const double step : steps_to_try) {
      Outcome outcome = run(start, physics, step, window_strain);
      print(arguments, window, step, outcome);
      if (step == reference_step) reference = std::move(outcome);
    }
    if (std::string(reference.ending) != "completed") return;
  }
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 6) {
    fmt::print(stderr, "usage: timestep_study VOLUME_FRACTION FRICTION SEED PARTICLES WINDOWS\n");
    return 2;
  }
  study({std::atof(arguments[1]), std::atof(arguments[2]), std::strtoull(arguments[3], nullptr, 10),
         std::strtoull(arguments[4], nullptr, 10), std::atoi(arguments[5])});
  return 0;
}
