// The state that a step starts from, and the way back to it.
#pragma once

#include "engine/state/system.h"

namespace peclet::engine {

class StepOrigin {
 public:
  // Copies what every step changes: places, motion, springs, cell and clock. The way back leads to them as
  // long as the list of neighbours is the same.
  void mark(const System& system, int threads);
  // Copies the list as well, if it has been rebuilt since it was last copied. The way back then leads across
  // rebuilds.
  void mark_with_list(const System& system, int threads);
  // Makes the system what it was at the mark, bit by bit. Requires a mark.
  void return_to(System& system, int threads) const;

  const VectorField& position() const { return marked_.particles.position; }
  const VectorField& velocity() const { return marked_.particles.velocity; }
  const VectorField& spin() const { return marked_.particles.angular_velocity; }
  const SpringField& springs() const { return marked_.springs; }

 private:
  System marked_;
};

}  // namespace peclet::engine
