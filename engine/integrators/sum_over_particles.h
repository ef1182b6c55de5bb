// Sums of stresses over particles, and velocities relative to the uniform flow.
#pragma once

#include <vector>

#include "engine/state/system.h"
#include "engine/threads/for_each_range.h"

namespace peclet::engine {

// The sum of of_particle(i) over all particles, with the same bits for any number of threads.
template <class OfParticle>
SymmetricTensor sum_over_particles(const System& system, int threads, OfParticle&& of_particle) {
  const std::vector<ParticleBlock>& blocks = system.list.blocks();
  std::vector<SymmetricTensor> sums(blocks.size());
  for_each_range(blocks.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      for (std::size_t i = blocks[b].begin; i < blocks[b].end; ++i) sums[b] += of_particle(i);
    }
  });
  SymmetricTensor total;
  for (const SymmetricTensor& sum : sums) total += sum;
  return total;
}

// A velocity at the place of a particle, relative to the uniform flow of the cell.
inline Vector3 relative_to_flow(const System& system, std::size_t i, const Vector3& velocity) {
  return velocity - system.box.velocity_gradient() * system.particles.position[i];
}

}  // namespace peclet::engine
