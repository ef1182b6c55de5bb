// A large system that is in the state of a small one.
#pragma once

#include "engine/state/system.h"

namespace peclet::engine {

// `times` copies of the system along each lattice vector, in a box as many times larger, at the same strain
// and step. Copies have numbers of their own, so that their noise differs. Contacts forget their springs.
System tiled(const System& system, int times);

}  // namespace peclet::engine
