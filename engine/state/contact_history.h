// Springs of touching pairs, and how they survive a rebuild of the neighbour list.
#pragma once

#include <vector>

#include "engine/state/neighbour_list.h"

namespace peclet::engine {

// Tangential and rolling spring of a pair; zero without contact.
struct ContactSprings {
  Vector3 tangential, rolling;
};

// The springs of one contact under a name that outlives the list. `image` is the shift between the unwrapped
// places of the two particles, which wrapping does not change.
struct HeldContact {
  std::uint32_t first, second;
  LatticeShift image;
  ContactSprings springs;
};

// All springs that are not zero, in the order of the list. springs[p] belongs to pair p.
std::vector<HeldContact> held_contacts(const NeighbourList& list, const std::vector<LatticeShift>& wrapped,
                                       const std::vector<ContactSprings>& springs);

// Springs of each pair of a new list. `wrapped` are the particles' image counters as they are now, in the
// same basis as `held`. A contact that is not listed any more has opened: its springs are forgotten.
std::vector<ContactSprings> placed_contacts(const NeighbourList& list,
                                            const std::vector<LatticeShift>& wrapped,
                                            const std::vector<HeldContact>& held);

}  // namespace peclet::engine
