#include "engine/realisation/packing.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "engine/integrators/midpoint.h"
#include "engine/integrators/stability.h"
#include "engine/state/cell_grid.h"
#include "engine/state/eigen_arrays.h"
#include "engine/state/neighbour_list.h"
#include "engine/terms/keyed_random.h"

namespace peclet::engine {
namespace {

constexpr double inflation = 1e-3;    // relative increase of the diameters in the minimisation
constexpr double smallest_gap = 0.2;  // smallest accepted gap, as a fraction of the inflation
constexpr int most_iterations = 40000;
constexpr double skin = 0.15;  // of the neighbour list, as a fraction of the ranges

// Overlaps and forces of the inflated spheres in one configuration.
struct Overlaps {
  double largest = 0;  // as a fraction of a_i + a_j
  double power = 0;    // sum of force . velocity
  double force_squared = 0, velocity_squared = 0;
};

// Minimises the overlaps of inflated spheres.
class Quench {
 public:
  Quench(ParticleState& particles, const PeriodicCell& box, const std::function<void()>& made_step)
      : particles_(particles), box_(box), made_step_(made_step), force_(particles.count()) {
    const std::vector<double> sizes = distinct_radii(particles.radius);
    RangeTable ranges(sizes.size());
    for (std::size_t a = 0; a < sizes.size(); ++a) {
      for (std::size_t b = 0; b < sizes.size(); ++b) {
        ranges.at(a, b) = (1 + inflation) * (sizes[a] + sizes[b]);
      }
    }
    list_ = NeighbourList(ranges, skin);
    list_.build(particles_, box_);
    step_ = 0.1;
  }

  // Runs FIRE with its published constants. Returns the smallest r / (a_i + a_j); above 1 without overlap.
  double run() {
    constexpr double longest_step = 0.7;
    double mixing = 0.1;
    int downhill = 0;
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
      const Overlaps overlaps = evaluate();
      if (overlaps.largest < (1 - smallest_gap) * inflation || overlaps.force_squared == 0) return closest();
      if (overlaps.force_squared < force_squared_of_jam()) {
        return closest();  // a minimum with overlaps: jammed
      }
      if (overlaps.power > 0) {
        steer(mixing * std::sqrt(overlaps.velocity_squared / overlaps.force_squared), 1 - mixing);
        if (++downhill > 5) {
          step_ = std::min(1.1 * step_, longest_step);
          mixing *= 0.99;
        }
      } else {
        steer(0, 0);
        step_ *= 0.5;
        mixing = 0.1;
        downhill = 0;
      }
      move();
      made_step_();
    }
    return closest();
  }

 private:
  Overlaps evaluate() {
    if (!list_.holds(particles_, box_)) list_.build(particles_, box_);
    force_ = VectorField(particles_.count());
    Overlaps overlaps;
    for (const Pair& pair : list_.pairs()) {
      const double contact = particles_.radius[pair.first] + particles_.radius[pair.second];
      const Vector3 r = separation(pair);
      const double distance = norm(r);
      const double overlap = (1 + inflation) * contact - distance;
      if (overlap > 0) {
        overlaps.largest = std::max(overlaps.largest, overlap / contact);
        const Vector3 push = (overlap / std::max(distance, 1e-9 * contact)) * r;
        force_.set(pair.first, force_[pair.first] - push);
        force_.set(pair.second, force_[pair.second] + push);
      }
    }
    for (std::size_t i = 0; i < particles_.count(); ++i) {
      const Vector3 f = force_[i], u = particles_.velocity[i];
      overlaps.power += dot(f, u);
      overlaps.force_squared += dot(f, f);
      overlaps.velocity_squared += dot(u, u);
    }
    return overlaps;
  }

  Vector3 separation(const Pair& pair) const {
    return particles_.position[pair.second] - particles_.position[pair.first] +
           box_.displacement(list_.images()[pair.image]);
  }

  void steer(double along_force, double keep) {
    array(particles_.velocity) = keep * array(particles_.velocity) + along_force * array(force_);
  }

  void move() {
    const double longest = 0.1 * *std::min_element(particles_.radius.begin(), particles_.radius.end());
    for (std::size_t i = 0; i < particles_.count(); ++i) {
      const Vector3 u = particles_.velocity[i] + step_ * force_[i];
      particles_.velocity.set(i, u);
      const Vector3 way = step_ * u;
      const double length = norm(way);
      particles_.position.set(i, particles_.position[i] + (length > longest ? longest / length : 1.0) * way);
    }
  }

  // Returns the squared force [length^2] below which a minimum is jammed: 1e-12 radii for each sphere.
  double force_squared_of_jam() const {
    const double radius = *std::min_element(particles_.radius.begin(), particles_.radius.end());
    return 1e-24 * radius * radius * static_cast<double>(particles_.count());
  }

  double closest() {
    double smallest = 1 + inflation;
    for (const Pair& pair : list_.pairs()) {
      const double contact = particles_.radius[pair.first] + particles_.radius[pair.second];
      smallest = std::min(smallest, norm(separation(pair)) / contact);
    }
    return smallest;
  }

  ParticleState& particles_;
  const PeriodicCell& box_;
  const std::function<void()>& made_step_;
  NeighbourList list_;
  VectorField force_;
  double step_;
};

// Returns the largest volume fraction, to 0.005, at which a quench from the present positions leaves no
// overlap. Bisects between the radii and `scale` times the radii, which are free of overlap.
double reached_volume_fraction(ParticleState particles, const PeriodicCell& box, double scale,
                               const std::function<void()>& made_step) {
  const std::vector<double> radius = particles.radius;
  const double wanted = solid_volume(particles) / box.volume();
  double free = wanted * scale * scale * scale, jammed = wanted;
  while (jammed - free > 0.005) {
    const double middle = 0.5 * (free + jammed), shrunk = std::cbrt(middle / wanted);
    for (std::size_t i = 0; i < radius.size(); ++i) particles.radius[i] = shrunk * radius[i];
    particles.velocity = VectorField(radius.size());
    (Quench(particles, box, made_step).run() > 1 ? free : jammed) = middle;
  }
  return free;
}

// Returns the value of(species) for each sphere, species by species.
template <class Of>
std::vector<double> of_each_sphere(const Particles& particles, const Of& of) {
  const std::vector<std::size_t> number = species_numbers(particles);
  std::vector<double> values;
  for (std::size_t s = 0; s < number.size(); ++s) {
    values.insert(values.end(), number[s], of(particles.species[s]));
  }
  return values;
}

}  // namespace

PackingError::PackingError(double wanted, double reached)
    : std::runtime_error(fmt::format(
          "no packing without overlap was found at volume fraction {:.4f}; the densest one found has {:.3f}",
          wanted, reached)),
      reached_(reached) {}

std::vector<double> species_radii(const Particles& particles) {
  return of_each_sphere(particles, [](const Species& species) { return species.radius; });
}

std::vector<double> species_densities(const Particles& particles) {
  return of_each_sphere(particles, [&](const Species& species) { return density_of(particles, species); });
}

double largest_overlap(const ParticleState& particles, const PeriodicCell& box) {
  const LatticePlaces places = lattice_places(particles.position, box);
  std::vector<std::uint32_t> all(particles.count());
  std::iota(all.begin(), all.end(), 0U);
  const std::vector<double>& radius = particles.radius;
  const double largest = *std::ranges::max_element(radius);
  const CellGrid grid(places, all, box, 2 * largest);
  double overlap = 0;
  for (const std::uint32_t i : all) {
    const double range = radius[i] + largest;
    grid.visit_near(places.fractional[i], range, [&](std::uint32_t j, const LatticeShift&, const Vector3& r) {
      if (j <= i) return;
      overlap = std::max(overlap, (radius[i] + radius[j] - norm(r)) / std::min(radius[i], radius[j]));
    });
  }
  return overlap;
}

double cube_edge(const std::vector<double>& radius, double volume_fraction) {
  return std::cbrt(solid_volume(radius) / volume_fraction);
}

double cube_edge(const Particles& particles, double volume_fraction) {
  const std::vector<std::size_t> number = species_numbers(particles);
  double volume = 0;
  for (std::size_t s = 0; s < number.size(); ++s) {
    const double a = particles.species[s].radius, of_one = 4.0 / 3.0 * std::numbers::pi * a * a * a;
    for (std::size_t i = 0; i < number[s]; ++i) {
      volume += of_one;  // one by one, as the sum over radii is rounded
    }
  }
  return std::cbrt(volume / volume_fraction);
}

void place_randomly(ParticleState& particles, const PeriodicCell& box, std::uint64_t seed,
                    const std::function<void()>& made_step) {
  const KeyedRandom random(seed, Purpose::packing);
  for (std::uint32_t i = 0; i < particles.count(); ++i) {
    particles.position.set(i, box.point_at(random.uniforms(0, i)));
  }
  const double closest = Quench(particles, box, made_step).run();
  if (!(closest > 1)) {
    throw PackingError(solid_volume(particles) / box.volume(),
                       reached_volume_fraction(particles, box, closest, made_step));
  }
  particles.velocity = VectorField(particles.count());
}

void relax(System& system, const Scene& scene, int threads, const std::function<void()>& made_step) {
  constexpr int most_steps = 200;
  const double timestep = automatic_implicit_timestep(scene).value;
  const double far = 0.05 * *std::min_element(system.particles.radius.begin(), system.particles.radius.end());
  Physics still = scene.physics;
  still.flow = {};
  still.thermal_energy = 0;
  if (still.contact) {
    still.contact->friction = 0;
    still.contact->rolling_stiffness = 0;
  }
  const PeriodicCell sheared = system.box;
  system.box.set_velocity_gradient({});
  double step = timestep;
  for (int made = 0; made < most_steps; ++made) {
    System trial = system;
    trial.particles.velocity = VectorField(trial.particles.count(), threads);
    trial.particles.angular_velocity = VectorField(trial.particles.count(), threads);
    Midpoint integrator(still, trial.particles, step, scene.solver_tolerance, 0, threads);
    integrator.start(trial);
    const StepReport report = integrator.advance(trial);
    made_step();
    if (!(report.largest_displacement <= far) || !report.sums.finite) {
      step /= 4;
      continue;
    }
    system = std::move(trial);
    if (step == timestep) break;
    step = std::min(2 * step, timestep);
  }
  system.step = 0;
  system.clock = {};
  system.box = sheared;
}

}  // namespace peclet::engine
