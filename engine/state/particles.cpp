#include "engine/state/particles.h"

#include <algorithm>
#include <numbers>
#include <numeric>

namespace peclet::engine {

std::vector<double> distinct_radii(const std::vector<double>& radius) {
  std::vector<double> distinct = radius;
  std::sort(distinct.begin(), distinct.end());
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  return distinct;
}

ParticleState make_particles(const std::vector<double>& radius, double density) {
  return make_particles(radius, std::vector<double>(radius.size(), density));
}

ParticleState make_particles(const std::vector<double>& radius, const std::vector<double>& density) {
  ParticleState particles;
  particles.radius = radius;
  const std::vector<double> sizes = distinct_radii(radius);
  for (std::size_t i = 0; i < radius.size(); ++i) {
    const double a = radius[i], mass = 4.0 / 3.0 * std::numbers::pi * density[i] * a * a * a;
    particles.mass.push_back(mass);
    particles.inertia.push_back(0.4 * mass * a * a);
    const auto place = std::lower_bound(sizes.begin(), sizes.end(), a);
    particles.size_class.push_back(static_cast<std::uint16_t>(place - sizes.begin()));
  }
  particles.position = particles.velocity = particles.angular_velocity = VectorField(radius.size());
  particles.image.resize(radius.size());
  particles.id.resize(radius.size());
  std::iota(particles.id.begin(), particles.id.end(), 0U);
  return particles;
}

void wrap_into_cell(ParticleState& particles, const PeriodicCell& box) {
  const CellFrame frame = box.frame();
  for (std::size_t i = 0; i < particles.count(); ++i) {
    const Vector3 place = frame.fractional(particles.position[i]);
    const LatticeShift removed = {static_cast<std::int32_t>(std::floor(place.x)),
                                  static_cast<std::int32_t>(std::floor(place.y)),
                                  static_cast<std::int32_t>(std::floor(place.z))};
    if (removed == LatticeShift{}) {
      continue;
    }
    particles.position.set(i, particles.position[i] - box.displacement(removed));
    particles.velocity.add(i, -box.velocity(removed));
    particles.image[i] = particles.image[i] + removed;
  }
}

double solid_volume(const ParticleState& particles) {
  double volume = 0;
  for (const double a : particles.radius) {
    volume += 4.0 / 3.0 * std::numbers::pi * a * a * a;
  }
  return volume;
}

}  // namespace peclet::engine
