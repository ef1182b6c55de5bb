// The block repulsion of a scene.
#pragma once

#include <optional>

#include "engine/scene/keys.h"
#include "engine/scene/scene_document.h"
#include "engine/terms/repulsion.h"

namespace peclet::engine {

inline Keys repulsion_keys() {
  return {
      block("/repulsion", "Repulsion of the surfaces, at distance h; absent: none."),
      must_be_given(
          choice("/repulsion/form", "exponential: energy strength * exp(-h / kappa).", {"exponential"})),
      not_negative("/repulsion/strength", "energy", "Energy of a pair that touches.", required),
      with_default(positive("/repulsion/relative_length", "", "kappa / (a_i + a_j)."), 0.01),
      with_default(
          positive("/repulsion/cutoff_lengths", "", "Distance h / kappa beyond which there is none."), 20),
  };
}

// None with a strength of 0.
inline std::optional<RepulsionParameters> read_repulsion(const SceneDocument& scene) {
  if (!(scene.number("/repulsion/strength") > 0)) return std::nullopt;
  return RepulsionParameters{scene.number("/repulsion/strength"), scene.number("/repulsion/relative_length"),
                             scene.number("/repulsion/cutoff_lengths")};
}

}  // namespace peclet::engine
