// Everything that moves: particles in their box, who is near whom, and what contacts remember.
#pragma once

#include "engine/state/archive.h"
#include "engine/state/contact_history.h"

namespace peclet::engine {

struct System {
  ParticleState particles;
  PeriodicCell box;
  NeighbourList list;
  SpringField springs;  // of each pair of the list
  std::uint64_t step = 0;
};

// Brings the basis of the box back to a compact one, the particles into the cell, neighbours close together
// in memory and the list up to date. Springs and unwrapped places are kept.
void rebuild_neighbours(System& system, int threads = 1);

// Everything above that the scene does not fix, bit by bit; load() also restores the list in its order.
void save(const System& system, ArchiveWriter& archive);
void load(System& system, ArchiveReader& archive);

}  // namespace peclet::engine
