#include "engine/realisation/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "engine/integrators/implicit.h"
#include "engine/integrators/velocity_verlet.h"
#include "engine/kernels/pair_recipes.h"
#include "engine/observables/script_process.h"
#include "engine/observables/structure.h"
#include "engine/realisation/packing.h"
#include "engine/realisation/schedule.h"
#include "engine/terms/drag.h"
#include "engine/terms/keyed_random.h"

namespace peclet::engine {
namespace {

// Skin of the neighbour list as a fraction of the smallest range. A small skin keeps the list close to the
// pairs that act; with large steps it would have to be rebuilt at every step.
constexpr double skin_of_explicit_steps = 0.03, skin_of_implicit_steps = 0.05;
constexpr double skin_of_candidates = 0.5;

// Displacement in a step beyond which implicit steps are divided, as a fraction of what the guard allows.
// Noise moves some of many particles that far in regular steps, so that its fraction is larger.
constexpr double guarded_share = 1.0 / 3, guarded_share_of_noise = 2.0 / 3;

// Number of comparisons of steps with half steps in the production window.
constexpr std::uint64_t comparisons = 8;

// Sets the velocities and spins of the streaming flow, and adds thermal ones if there is a temperature.
void set_initial_velocities(ParticleState& particles, const BackgroundFlow& flow, const Physics& physics,
                            std::uint64_t seed) {
  const KeyedRandom random(seed, Purpose::initial_velocity);
  for (std::uint32_t i = 0; i < particles.count(); ++i) {
    Vector3 velocity = flow.velocity(particles.position[i], particles.radius[i]);
    Vector3 spin = flow.spin(particles.position[i]);
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

Simulation::Simulation(const Scene& scene, const Schedule& schedule, std::uint64_t seed, int threads,
                       const std::string& file)
    : scene_(scene),
      schedule_(schedule),
      random_key_(random_key(scene, schedule, seed)),
      threads_(threads),
      production_(schedule.production) {
  driver_ = make_driver(scene_, schedule.timestep, random_key_);
  const Physics& physics = scene_.physics;
  check_fit(scene, schedule, file);
  const std::vector<double> radius = species_radii(scene.particles);
  const std::vector<double> sizes = distinct_radii(radius);
  const Vector3 box = box_lengths(scene, cube_edge(radius, scene.volume_fraction));
  kinds_ = make_pair_kinds(physics, sizes);
  smallest_radius_ = sizes.front();
  system_.particles = make_particles(radius, species_densities(scene.particles));
  const Deformation& deformation = physics.flow.deformation();
  system_.box = PeriodicCell::with_edges(deformation.edges_at_start(box), deformation.velocity_gradient(0));
  edges_at_start_ = system_.box.edges();
  const RangeTable ranges = range_table(kinds_, sizes.size());
  system_.list = scene.method == Method::implicit_steps
                     ? NeighbourList(ranges, skin_of_implicit_steps, skin_of_candidates)
                     : NeighbourList(ranges, skin_of_explicit_steps);
  system_.springs = SpringField(spring_kinds(required_terms(physics)), 0);
  if (scene.method == Method::implicit_steps) {
    std::unique_ptr<Implicit> steps = implicit_steps(physics, system_.particles, schedule.timestep,
                                                     scene.solver_tolerance, random_key_, threads);
    const double share = physics.thermal_energy > 0 ? guarded_share_of_noise : guarded_share;
    steps->divide_steps(share * scene.guard.largest_displacement * smallest_radius_);
    integrator_ = std::move(steps);
  } else {
    integrator_ = std::make_unique<VelocityVerlet>(
        ForceField(physics, system_.particles, schedule.timestep, random_key_, threads), system_.particles,
        schedule.timestep);
  }
  observables_ = make_observables(scene, {schedule.timestep, schedule.production, box}, file);
  const auto takes_flux = [](const auto& observable) { return observable->takes_flux(); };
  if (std::ranges::any_of(observables_, takes_flux)) integrator_->watch_motion();
}

void Simulation::start(const std::function<void()>& made_step) {
  place_randomly(system_.particles, system_.box, random_key_, made_step);
  if (required_terms(scene_.physics).conservative) relax(system_, scene_, threads_, made_step);
  set_initial_velocities(system_.particles, scene_.physics.flow.at(system_.box), scene_.physics, random_key_);
  begin();
}

void Simulation::begin() {
  integrator_->start(system_);
  driver_->start(system_);
}

void Simulation::start(const System& placed, bool in_motion) {
  if (placed.particles.count() != system_.particles.count()) {
    throw std::invalid_argument("the scene has another number of particles");
  }
  system_.springs = SpringField(system_.springs.kinds(), 0);
  system_.particles = placed.particles;
  system_.box = placed.box;
  if (placed.box.displacement_gradient() == Matrix3{}) edges_at_start_ = placed.box.edges();
  system_.step = placed.step;
  system_.clock = placed.clock;
  if (!in_motion) {
    set_initial_velocities(system_.particles, scene_.physics.flow.at(system_.box), scene_.physics,
                           random_key_);
  }
  begin();
}

std::optional<Ending> Simulation::advance(std::uint64_t steps) {
  const std::uint64_t last = system_.step + steps;
  while (system_.step < std::min(last, schedule_.total())) {
    if (std::optional<Ending> ending = check_stability()) return ending;
    const StepReport report = driver_->advance(*integrator_, system_, watchers_of_step());
    if (std::optional<Ending> ending = ending_of(report, system_, scene_.guard, smallest_radius_)) {
      integrator_->complete(system_);
      return ending;
    }
    if (system_.step > schedule_.equilibration) {
      if (std::optional<Ending> ending = observe(report)) return ending;
    }
    if (std::optional<Ending> ending = driver_->ending(system_, schedule_)) return ending;
  }
  integrator_->complete(system_);
  if (system_.step == schedule_.total()) {
    return Ending{Ending::Cause::completed, system_.step, "the production window is complete"};
  }
  return std::nullopt;
}

// Returns the observables that sample the next step, or null.
PairWatcher* Simulation::watchers_of_step() {
  watchers_.clear();
  if (system_.step >= schedule_.equilibration) {
    const std::uint64_t index = system_.step - schedule_.equilibration;
    for (const std::unique_ptr<Observable>& observable : observables_) {
      if (index % observable->interval() == 0) watchers_.add(observable->watcher());
    }
  }
  return watchers_.empty() ? nullptr : &watchers_;
}

double Simulation::take_seconds() {
  double seconds = 0;
  for (const std::unique_ptr<Observable>& observable : observables_) seconds += observable->take_seconds();
  return seconds;
}

gsd::Frames* Simulation::frames() {
  for (const std::unique_ptr<Observable>& observable : observables_) {
    if (gsd::Frames* const frames = observable->frames()) return frames;
  }
  return nullptr;
}

std::optional<Ending> Simulation::observe(const StepReport& report) {
  const std::uint64_t index = system_.step - schedule_.equilibration - 1;
  production_.add_step(index, report.sums, report.motion, system_.box.velocity_gradient().column[1].x);
  largest_overlap_ = std::max(largest_overlap_, report.sums.largest_overlap);
  note_errors(index, report);
  if (index % at_most_a_block(integrator_->intervals().sampling) == 0) {
    integrator_->complete(system_);
    production_.add_sample(index, structural_brownian_stress(system_, kinds_, scene_.physics.thermal_energy),
                           varying_stresslet(system_.particles, system_.box, scene_.physics),
                           kinetic_temperatures(system_, scene_.physics.flow));
  }
  const MomentumFlux flux = flux_of(report.sums, report.motion);
  for (const std::unique_ptr<Observable>& observable : observables_) {
    observable->take_flux(flux);
    if (index % observable->interval() != 0) continue;
    integrator_->complete(system_);
    try {
      observable->sample(system_, production_.block_at(index));
    } catch (const ScriptError& error) {
      return Ending{Ending::Cause::script, system_.step, error.what()};
    }
  }
  return std::nullopt;
}

std::optional<Ending> Simulation::check_stability() {
  if (system_.step % integrator_->intervals().stability != 0) return std::nullopt;
  integrator_->complete(system_);
  const double share = integrator_->stability_share(system_);
  errors_.largest_stability_share = std::max(errors_.largest_stability_share, share);
  if (share < 1) return std::nullopt;
  // The share, 2 l dt + w^2 dt^2, shrinks at least in proportion to dt, so that step / share is stable.
  const double step = integrator_->timestep();
  return Ending{
      Ending::Cause::timestep, system_.step,
      fmt::format("the step {:.4g} is too large for the packing at strain {:.4g}, which allows {:.4g}", step,
                  system_.box.strain(), step / share)};
}

void Simulation::note_errors(std::uint64_t index, const StepReport& report) {
  errors_.solver_iterations += static_cast<std::uint64_t>(report.solver_iterations);
  errors_.sum_of_solver_residuals += report.solver_residual;
  errors_.largest_solver_residual = std::max(errors_.largest_solver_residual, report.solver_residual);
  errors_.divided_steps += report.division > 0 ? 1 : 0;
  errors_.deepest_division = std::max(errors_.deepest_division, static_cast<std::uint64_t>(report.division));
  const Integrator::Intervals intervals = integrator_->intervals();
  if (index % at_most_a_block(intervals.energy) == 0) {
    integrator_->complete(system_);
    if (const std::optional<double> energy = integrator_->spurious_energy(system_)) {
      errors_.spurious_energy += *energy;
      ++errors_.samples;
    }
  }
  const std::uint64_t between = steps_between_comparisons();
  if (between > 0 && (index + 1) % between == 0) compare_half_steps();
}

std::uint64_t Simulation::steps_between_comparisons() const {
  const bool is_smooth = scene_.physics.thermal_energy == 0 && scene_.physics.flow.is_steady();
  if (!is_smooth) return 0;
  return std::max(schedule_.production / comparisons, integrator_->intervals().comparison);
}

void Simulation::compare_half_steps() {
  integrator_->complete(system_);
  const Integrator::HalfSteps sample =
      integrator_->compare_half_steps(system_, integrator_->intervals().compared_steps);
  errors_.half_steps.whole += sample.whole;
  errors_.half_steps.halved += sample.halved;
}

void Simulation::save(ArchiveWriter& archive) const {
  archive.put(edges_at_start_);
  engine::save(system_, archive);
  integrator_->save(archive);
  driver_->save(archive);
  archive.put(errors_);
  archive.put_all(schedule_.equilibration, largest_overlap_, production_);
  for (const std::unique_ptr<Observable>& observable : observables_) observable->save(archive);
}

void Simulation::load_system(ArchiveReader& archive) {
  archive.get_all(edges_at_start_);
  system_.box = PeriodicCell::with_edges(edges_at_start_, system_.box.velocity_gradient());
  engine::load(system_, archive);
}

void Simulation::load(ArchiveReader& archive) {
  load_system(archive);
  integrator_->load(archive);
  driver_->load(system_, archive);
  archive.get_all(errors_);
  archive.get_all(schedule_.equilibration, largest_overlap_, production_);
  for (const std::unique_ptr<Observable>& observable : observables_) observable->load(archive);
}

void Simulation::load_motion(ArchiveReader& archive) {
  load_system(archive);
  integrator_->load(archive);
  driver_->load(system_, archive);
  if (system_.step >= schedule_.equilibration) driver_->begin_window(system_);
  errors_ = {.largest_stability_share = archive.get<StepErrors>().largest_stability_share};
}

}  // namespace peclet::engine
