// Which particles are neighbours in memory.
#pragma once

#include "engine/state/particles.h"

namespace peclet::engine {

// Rearranges the particles along a Morton curve through the cell, so that those of one block stand close
// together. Positions must lie in the cell. Systems of one block stay as they are. The order is a function of
// the positions and of the order before. Rows move to new memory, which each thread fills for its own blocks.
void arrange_along_curve(ParticleState& particles, const PeriodicCell& box, int threads = 1);

// Rearranges particles that stand in order of their ids (as they are made) so that particles.id becomes `id`.
// Throws ArchiveError when `id` is no permutation.
void arrange_by_id(ParticleState& particles, const std::vector<std::uint32_t>& id);

}  // namespace peclet::engine
