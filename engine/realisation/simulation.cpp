#include "engine/realisation/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "contract/input_error.h"
#include "engine/integrators/implicit.h"
#include "engine/integrators/velocity_verlet.h"
#include "engine/kernels/pairs/terms.h"
#include "engine/observables/catalogue.h"
#include "engine/random/keyed_random.h"
#include "engine/realisation/scene_fit.h"
#include "engine/stability/stability.h"
#include "engine/start/packing.h"
#include "engine/start/relaxation.h"
#include "engine/terms/drag.h"

namespace peclet::engine {
namespace {

// Steps and half steps are compared a few times in a run.
constexpr std::uint64_t comparisons = 8;

// Pairs are listed that much beyond their range, as a fraction of the smallest one. A small skin keeps the
// list close to the pairs that act; large steps would use it up at once.
constexpr double skin_of_explicit_steps = 0.03, skin_of_implicit_steps = 0.1;

// Thousands of years of computing; step counters hold far more.
constexpr double most_steps = 1e15;

// The time after which the first of the limits is reached.
double time_of(const Duration& duration, const Scene& scene) {
  const Physics& physics = scene.physics;
  double time = duration.time;
  if (physics.shear_rate > 0) {
    time = std::min(time, duration.strain / physics.shear_rate);
  }
  if (physics.thermal_energy > 0) {
    const double a = scene.particles.reference_radius;
    time = std::min(time, duration.brownian_times * physics.viscosity * a * a * a / physics.thermal_energy);
  }
  return time;
}

// Steps of the phase called `name`. Throws InputError when there are too many to count.
std::uint64_t steps_of(const Duration& duration, const char* name, const Scene& scene, double timestep,
                       const std::string& file) {
  // A duration that is a whole number of steps must not gain one by rounding.
  const double steps = std::ceil(time_of(duration, scene) / timestep * (1 - 1e-12));
  if (!(steps <= most_steps)) {
    throw InputError(file, std::string("/duration/") + name, scene.document.at("duration").at(name).dump(),
                     fmt::format("must last at most {:g} steps of {:.4g}", most_steps, timestep));
  }
  return static_cast<std::uint64_t>(steps);
}

// The streaming flow's velocities, and those of equilibrium where there is a temperature.
void set_initial_velocities(ParticleState& particles, const Physics& physics, std::uint64_t seed) {
  const KeyedRandom random(seed, Purpose::initial_velocity);
  for (std::uint32_t i = 0; i < particles.count(); ++i) {
    Vector3 velocity = streaming_velocity(physics.shear_rate, particles.position[i].y);
    Vector3 spin = streaming_spin(physics.shear_rate);
    if (physics.thermal_energy > 0) {
      const NormalPair normals = random.normals(0, particles.id[i]);
      velocity += std::sqrt(physics.thermal_energy / particles.mass[i]) * normals.first;
      spin += std::sqrt(physics.thermal_energy / particles.inertia[i]) * normals.second;
    }
    particles.velocity.set(i, velocity);
    particles.angular_velocity.set(i, spin);
  }
}

}  // namespace

const char* name_of(Ending::Cause cause) {
  switch (cause) {
    case Ending::Cause::completed:
      return "completed";
    case Ending::Cause::overlap:
      return "overlap";
    case Ending::Cause::displacement:
      return "displacement";
    case Ending::Cause::non_finite:
      return "non-finite";
    case Ending::Cause::packing:
      return "packing";
    case Ending::Cause::timestep:
      return "timestep";
  }
  return "";
}

Schedule make_schedule(const Scene& scene, const std::string& file) {
  Schedule schedule;
  schedule.timestep = resolved_timestep(scene, file);
  if (!scene.timestep) {
    // A short window is divided into as many steps as it needs.
    schedule.timestep = std::min(schedule.timestep, time_of(scene.production, scene) / count_of_blocks);
  }
  if (!std::isnormal(schedule.timestep)) {
    throw InputError(
        file, "/integrator/timestep", fmt::format("{}", schedule.timestep),
        "must come out as a number above 0: sizes, forces or durations of the scene are beyond what "
        "can be computed with; choose other units");
  }
  schedule.equilibration = steps_of(scene.equilibration, "equilibration", scene, schedule.timestep, file);
  schedule.production = steps_of(scene.production, "production", scene, schedule.timestep, file);
  if (schedule.production < count_of_blocks) {
    throw InputError(file, "/duration/production", scene.document.at("duration").at("production").dump(),
                     fmt::format("must last at least {} steps of {:.4g}, one for each block", count_of_blocks,
                                 schedule.timestep));
  }
  return schedule;
}

Simulation::Simulation(const Scene& scene, const Schedule& schedule, std::uint64_t seed, int threads,
                       const std::string& file)
    : scene_(scene), schedule_(schedule), seed_(seed), threads_(threads), production_(schedule.production) {
  const Physics& physics = scene.physics;
  check_fit(scene, schedule, file);
  const std::vector<double> radius = species_radii(scene.particles);
  const std::vector<double> sizes = distinct_radii(radius);
  const double edge = cube_edge(radius, scene.volume_fraction);
  kinds_ = make_pair_kinds(physics, sizes);
  smallest_radius_ = sizes.front();
  system_.particles = make_particles(radius, scene.particles.density);
  system_.box = ShearedBox({edge, edge, edge}, physics.shear_rate);
  const double skin =
      scene.method == Method::implicit_steps ? skin_of_implicit_steps : skin_of_explicit_steps;
  system_.list = NeighbourList(range_table(kinds_, sizes.size()), skin);
  system_.springs = SpringField(spring_kinds(required_terms(physics)), 0);
  if (scene.method == Method::implicit_steps) {
    integrator_ = std::make_unique<Implicit>(physics, system_.particles, schedule.timestep,
                                             scene.solver_tolerance, seed, threads);
  } else {
    integrator_ = std::make_unique<VelocityVerlet>(
        ForceField(physics, system_.particles, schedule.timestep, seed, threads), system_.particles,
        schedule.timestep);
  }
  observables_ = make_observables(scene, system_, schedule.timestep, schedule.production);
}

void Simulation::start() {
  place_randomly(system_.particles, system_.box, seed_);
  if (required_terms(scene_.physics).conservative) {
    relax(system_, scene_, threads_);
  }
  set_initial_velocities(system_.particles, scene_.physics, seed_);
  integrator_->start(system_);
}

void Simulation::start(const System& placed) {
  if (placed.particles.count() != system_.particles.count()) {
    throw std::invalid_argument("the scene has another number of particles");
  }
  system_.springs = SpringField(system_.springs.kinds(), 0);
  system_.particles = placed.particles;
  system_.box = placed.box;
  system_.step = placed.step;
  integrator_->start(system_);
}

std::optional<Ending> Simulation::advance(std::uint64_t steps) {
  const Integrator::Intervals intervals = integrator_->intervals();
  const std::uint64_t last = std::min(system_.step + steps, schedule_.total());
  while (system_.step < last) {
    if (system_.step % intervals.stability == 0) {
      integrator_->complete(system_);
      if (std::optional<Ending> ending = check_step()) {
        return ending;
      }
    }
    const StepReport report = integrator_->advance_open(system_);
    if (std::optional<Ending> ending = verdict(report)) {
      integrator_->complete(system_);
      return ending;
    }
    if (system_.step > schedule_.equilibration) {
      observe(report);
    }
  }
  integrator_->complete(system_);
  if (system_.step == schedule_.total()) {
    return Ending{Ending::Cause::completed, system_.step, "the production window is complete"};
  }
  return std::nullopt;
}

std::optional<Ending> Simulation::check_step() {
  const double share = integrator_->stability_share(system_);
  step_errors_.largest_stability_share = std::max(step_errors_.largest_stability_share, share);
  if (share < 1) {
    return std::nullopt;
  }
  // 2 l dt + w^2 dt^2 shrinks at least in proportion to dt.
  const double step = integrator_->timestep();
  return Ending{
      Ending::Cause::timestep, system_.step,
      fmt::format("the step {:.4g} is too large for the packing at strain {:.4g}, which allows {:.4g}", step,
                  system_.box.strain(), step / share)};
}

std::optional<Ending> Simulation::verdict(const StepReport& report) const {
  const double displacement = report.largest_displacement / smallest_radius_;
  if (!std::isfinite(displacement) || !report.sums.finite) {
    return Ending{Ending::Cause::non_finite, system_.step, "a position or velocity is not finite"};
  }
  // Whatever the guard, spheres must not leap over each other: the integrator evaluates no forces then.
  const double largest =
      std::min(scene_.guard.largest_displacement, 0.5 * system_.list.ranges().largest() / smallest_radius_);
  if (displacement > largest) {
    return Ending{
        Ending::Cause::displacement, system_.step,
        fmt::format("a particle moved {:.3g} radii in one step, more than {:.3g}", displacement, largest)};
  }
  if (report.sums.largest_overlap > scene_.guard.largest_overlap) {
    return Ending{Ending::Cause::overlap, system_.step,
                  fmt::format("two particles overlap by {:.3g} radii, more than {:.3g}: jammed, or too soft",
                              report.sums.largest_overlap, scene_.guard.largest_overlap)};
  }
  return std::nullopt;
}

void Simulation::observe(const StepReport& report) {
  const std::uint64_t index = system_.step - schedule_.equilibration - 1;
  const Integrator::Intervals intervals = integrator_->intervals();
  production_.add_step(index, report.sums);
  largest_overlap_ = std::max(largest_overlap_, report.sums.largest_overlap);
  step_errors_.solver_iterations += static_cast<std::uint64_t>(report.solver_iterations);
  step_errors_.sum_of_solver_residuals += report.solver_residual;
  step_errors_.largest_solver_residual =
      std::max(step_errors_.largest_solver_residual, report.solver_residual);
  // A short window is sampled more often so that each block has its samples.
  const std::uint64_t longest_interval = schedule_.production / count_of_blocks;
  if (index % std::min(intervals.energy, longest_interval) == 0) {
    integrator_->complete(system_);
    if (const std::optional<double> energy = integrator_->spurious_energy(system_)) {
      step_errors_.spurious_energy += *energy;
      ++step_errors_.samples;
    }
  }
  const std::uint64_t between = std::max(schedule_.production / comparisons, intervals.comparison);
  const bool smooth = scene_.physics.thermal_energy == 0 && scene_.physics.shear_rate > 0;
  if (smooth && (index + 1) % between == 0) {
    integrator_->complete(system_);
    const Integrator::HalfSteps sample = integrator_->compare_half_steps(system_, intervals.compared_steps);
    step_errors_.half_steps.whole += sample.whole;
    step_errors_.half_steps.halved += sample.halved;
  }
  if (index % std::min(intervals.sampling, longest_interval) == 0) {
    integrator_->complete(system_);
    production_.add_sample(index, structural_brownian_stress(system_, kinds_, scene_.physics.thermal_energy),
                           kinetic_temperatures(system_));
  }
  for (const std::unique_ptr<Observable>& observable : observables_) {
    if (index % observable->interval() != 0) continue;
    integrator_->complete(system_);
    observable->sample(system_);
  }
}

void Simulation::save(ArchiveWriter& archive) const {
  engine::save(system_, archive);
  integrator_->save(archive);
  production_.save(archive);
  for (const std::unique_ptr<Observable>& observable : observables_) observable->save(archive);
  archive.put(step_errors_);
  archive.put(largest_overlap_);
}

void Simulation::load(ArchiveReader& archive) {
  engine::load(system_, archive);
  integrator_->load(system_, archive);
  production_.load(archive);
  for (const std::unique_ptr<Observable>& observable : observables_) observable->load(archive);
  step_errors_ = archive.get<StepErrors>();
  largest_overlap_ = archive.get<double>();
}

}  // namespace peclet::engine
