#include "engine/scene/smallest_count.h"

#include <algorithm>
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
  const auto is_enough = [&](std::size_t count) {
    particles.count = count;
    return has_every_size(particles);
  };
  std::size_t below = 0, enough = most_particles;
  if (!is_enough(enough)) return 0;
  while (enough - below > 1) {
    const std::size_t middle = below + (enough - below) / 2;
    (is_enough(middle) ? enough : below) = middle;
  }
  return enough;
}

}  // namespace peclet::engine
