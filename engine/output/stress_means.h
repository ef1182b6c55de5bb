// The stress and what is measured with it at every step: means in the units of the result, their blocks, and
// the descriptions of all of them.
#pragma once

#include <vector>

#include "contract/json.h"
#include "engine/kernels/pairs/terms.h"
#include "engine/observables/production.h"
#include "engine/observables/quantity.h"
#include "engine/realisation/simulation.h"
#include "engine/scene/scene.h"

namespace peclet::engine {

class StressMeans {
 public:
  StressMeans(const Scene& scene, const System& system);

  // Of these sums. Stresses are divided by viscosity * shear_rate, or in the scene's units at rest.
  // `has_jammed`: the flow at a given stress stands still in the end.
  Json means(const BlockSums& sums, bool has_jammed = false) const;
  // Of all blocks: what is one number, and xy of every stress that fluctuates, in 32 of them; whole tensors
  // in the quarters of the window. Five digits.
  Json blocks(const Production& production) const;

 private:
  // Of a flow at a given stress.
  void add_flow(const BlockSums& sums, double stress, bool has_jammed, Json& means) const;

  const Physics& physics_;
  double volume_, volume_fraction_, particles_, unit_;
  bool notices_jams_;
};

// Those that means() of the scene have as numbers.
std::vector<Quantity> stress_quantities(const Scene& scene);

}  // namespace peclet::engine
