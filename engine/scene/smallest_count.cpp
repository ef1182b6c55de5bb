#include "engine/scene/smallest_count.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace peclet::engine {

bool has_every_size(const Particles& particles) {
  const std::vector<std::size_t> number = species_numbers(particles);
  std::set<double> present;
  for (std::size_t s = 0; s < number.size(); ++s) {
    if (number[s] > 0) present.insert(particles.species[s].radius);
  }
  return std::ranges::all_of(particles.species, [&](const Species& s) { return present.contains(s.radius); });
}

std::size_t smallest_count(Particles particles) {
  particles.count = 1;
  const std::vector<double> exact = exact_numbers(particles);
  std::map<double, double> share;
  for (std::size_t s = 0; s < exact.size(); ++s) share[particles.species[s].radius] += exact[s];
  double least = 1;
  for (const auto& [radius, part] : share) least = std::min(least, part);
  // Grains of a mixture are rounded one after the other, and may want a few more.
  for (double count = std::ceil(1 / least - 1e-9); count <= most_particles;
       count += 1 + std::floor(count / 50)) {
    particles.count = static_cast<std::size_t>(count);
    if (has_every_size(particles)) return particles.count;
  }
  return 0;
}

}  // namespace peclet::engine
