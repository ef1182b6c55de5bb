// The block lubrication of a scene.
#pragma once

#include "engine/scene/keys.h"
#include "engine/scene/scene_document.h"
#include "engine/terms/lubrication.h"

namespace peclet::engine {

inline Keys lubrication_keys() {
  return {
      block("/lubrication", "Squeeze, shear and pump modes between near spheres; absent: none."),
      must_be_given(choice("/lubrication/form", "The resistance functions.", {"kim-karrila"})),
      with_default(
          fraction(positive("/lubrication/inner_gap", "",
                            "Gap 2 (r - a_i - a_j) / (a_i + a_j) below which the resistance stays constant."),
                   1),
          1e-3),
      with_default(fraction(positive("/lubrication/outer_gap", "",
                                     "Gap beyond which there is none; must be larger than inner_gap."),
                            1),
                   0.05),
  };
}

inline LubricationParameters read_lubrication(const SceneDocument& scene) {
  const LubricationParameters lubrication{scene.number("/lubrication/inner_gap"),
                                          scene.number("/lubrication/outer_gap")};
  if (lubrication.inner_gap >= lubrication.outer_gap) {
    scene.refuse("/lubrication/inner_gap", "must be a number > 0 and < /lubrication/outer_gap, which is " +
                                               shortened(scene.at("/lubrication/outer_gap")));
  }
  return lubrication;
}

}  // namespace peclet::engine
