// Everything that moves: particles in their box, who is near whom, and what contacts remember.
#pragma once

#include "engine/state/archive.h"
#include "engine/state/contact_history.h"

namespace peclet::engine {

// Time as equal steps, which are counted rather than added up: a long run gathers no rounding errors.
struct Clock {
  double origin = 0;  // when steps of the present size began
  double timestep = 0;
  std::uint64_t steps = 0;  // since then

  double time() const { return origin + static_cast<double>(steps) * timestep; }

  // From now on in steps of this size.
  void count_in(double step) {
    if (step != timestep) {
      *this = {time(), step, 0};
    }
  }
  // The same moment, and from now on in steps of which so many make one.
  Clock with_parts(int parts) const {
    return {origin, timestep / parts, steps * static_cast<std::uint64_t>(parts)};
  }
};

struct System {
  ParticleState particles;
  PeriodicCell box;
  NeighbourList list;
  SpringField springs;     // of each pair of the list
  std::uint64_t step = 0;  // names the noise
  std::uint64_t part = 1;  // of that step (NoiseKey); 1 between steps
  Clock clock;
};

// Brings the basis of the box back to a compact one, the particles into the cell, neighbours close together
// in memory and the list up to date. Springs and unwrapped places are kept.
void rebuild_neighbours(System& system, int threads = 1);

// Everything above that the scene does not fix, bit by bit; load() also restores the list in its order.
void save(const System& system, ArchiveWriter& archive);
void load(System& system, ArchiveReader& archive);

}  // namespace peclet::engine
