// The block attraction of a scene.
#pragma once

#include <optional>

#include "engine/flow/scene_document.h"
#include "engine/terms/attraction.h"

namespace peclet::engine {

inline constexpr const char* attraction_keys = R"(
/attraction? | object | Van der Waals attraction of the surfaces, at distance h: force A_H a / (12 (h^2 +
    eps^2)), in overlap as at h = 0, with a = 2 a_i a_j / (a_i + a_j); absent: none.
/attraction/hamaker | number >= 0; in energy; named Hamaker constant, A_H | Hamaker constant A_H.
/attraction/regularisation | number > 0; default 0.01 | eps / a.
/attraction/cutoff | number > 0; in length | Distance h beyond which there is none.
)";

// None with a constant of 0.
inline std::optional<AttractionParameters> read_attraction(const SceneDocument& scene) {
  if (!(scene.number("/attraction/hamaker") > 0)) return std::nullopt;
  return AttractionParameters{scene.number("/attraction/hamaker"), scene.number("/attraction/regularisation"),
                              scene.number("/attraction/cutoff")};
}

}  // namespace peclet::engine
