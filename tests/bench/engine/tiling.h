// Builds a large system from copies of a small one.
#pragma once

#include "engine/state/system.h"

namespace peclet::engine {

// Returns `times` copies of the system along each lattice vector, in a box `times` as large at the same
// strain and step. Copies have ids of their own, so their noise differs. Contacts lose their springs.
System tiled(const System& system, int times);

}  // namespace peclet::engine
