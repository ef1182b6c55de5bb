// The pairs of a configuration that touch, and what their springs do.
#pragma once

#include <vector>

#include "engine/kernels/pairs/pair_access.h"
#include "engine/state/system.h"
#include "engine/terms/contact.h"

namespace peclet::engine {

// A spring that is cut at each step is as long as it may be but for what the step itself changes.
constexpr double sliding_from = 0.99;

struct TouchingPair {
  const Pair& pair;
  double distance, overlap;  // of centres; delta = a_i + a_j - distance > 0
  double tangential_force;   // |F_t| = k_t |s|
  bool rough;                // whether it has friction: k_n delta above the critical load
  double mobilised;          // |F_t| / (mu frictional_load()), 0 without friction
  bool slides;               // as it remembers, or else by `mobilised`
};

// In the order of the list.
template <class Visit>
void for_each_touching_pair(const System& system, const std::vector<PairKind>& kinds,
                            const ContactParameters& contact, const Visit& visit) {
  const std::vector<ImageFrame> frames = image_frames(system.list, system.box);
  const std::vector<Pair>& pairs = system.list.pairs();
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const Pair& pair = pairs[p];
    const double distance = norm(separation(system.particles, pair, frames[pair.image]));
    const double overlap = kinds[pair.kind].sum_of_radii - distance;
    if (!(overlap > 0)) continue;
    const double load = frictional_load(contact, overlap);
    const bool rough = contact.friction > 0 && load > 0;
    const double force = rough ? contact.tangential_stiffness * norm(system.springs[p].tangential) : 0;
    const double mobilised = rough ? force / (contact.friction * load) : 0;
    const bool slides = system.springs.remembers_sliding() ? rough && system.springs[p].slides != 0
                                                           : mobilised > sliding_from;
    visit({pair, distance, overlap, force, rough, mobilised, slides});
  }
}

}  // namespace peclet::engine
