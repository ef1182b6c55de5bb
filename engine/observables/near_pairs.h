// The pairs of a configuration within a distance, whatever the range of their forces is.
#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

#include "engine/state/cell_grid.h"
#include "engine/state/system.h"

namespace peclet::engine {

// Calls visit(i, j, separation) for every sphere i and each image of another sphere j that is closer than
// `range`, and for some that are further away: every pair from both ends. `separation` leads from i to j. The
// order depends on the configuration alone.
template <class Visit>
void for_each_near_pair(const System& system, double range, const Visit& visit) {
  const LatticePlaces places = lattice_places(system.particles.position, system.box);
  std::vector<std::uint32_t> everyone(system.particles.count());
  std::iota(everyone.begin(), everyone.end(), 0U);
  const CellGrid grid(places, everyone, system.box, range);
  for (std::uint32_t i = 0; i < everyone.size(); ++i) {
    grid.visit_near(places.fractional[i], range,
                    [&](std::uint32_t j, LatticeShift, const Vector3& separation) {
                      if (j != i) visit(i, j, separation);
                    });
  }
}

}  // namespace peclet::engine
