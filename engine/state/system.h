// The state of a simulation: particles, their box, the neighbour list, contact springs and the clock.
#pragma once

#include "engine/state/archive.h"
#include "engine/state/contact_history.h"

namespace peclet::engine {

// Time in equal steps, which are counted rather than added up: rounding errors do not accumulate.
struct Clock {
  double origin = 0;  // time when steps of the present size began
  double timestep = 0;
  std::uint64_t steps = 0;  // since the origin

  double time() const { return origin + static_cast<double>(steps) * timestep; }

  // Counts in steps of this size from now on.
  void count_in(double step) {
    if (step != timestep) {
      *this = {time(), step, 0};
    }
  }
  // Returns a clock at the same time, with steps divided into `parts`.
  Clock with_parts(int parts) const {
    return {origin, timestep / parts, steps * static_cast<std::uint64_t>(parts)};
  }
};

struct System {
  ParticleState particles;
  PeriodicCell box;
  NeighbourList list;
  SpringField springs;     // for each pair of the list
  std::uint64_t step = 0;  // number of the step, which keys the noise
  std::uint64_t part = 1;  // part of the step (NoiseKey); 1 between steps
  Clock clock;
};

// Updates the neighbour list. Unless its candidates still hold, makes the basis of the box compact, wraps the
// particles into the cell and arranges them in memory before. Springs and unwrapped positions are kept.
void rebuild_neighbours(System& system, int threads = 1);

// Save and load, bit by bit, what the scene does not fix. load() also restores the list in its order; it
// throws ArchiveError if the state cannot belong to this system.
void save(const System& system, ArchiveWriter& archive);
void load(System& system, ArchiveReader& archive);

}  // namespace peclet::engine
