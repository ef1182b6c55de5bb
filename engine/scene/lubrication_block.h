// The block lubrication of a scene.
#pragma once

#include <fmt/format.h>

#include <optional>
#include <string>

#include "engine/flow/scene_document.h"
#include "engine/terms/lubrication.h"

namespace peclet::engine {

inline constexpr const char* lubrication_keys = R"(
/lubrication? | object | Squeeze, shear and pump modes between near spheres; absent: none.
/lubrication/form | one of kim-karrila, mari; named form of the lubrication | kim-karrila: resistances of the
    gap xi = 2 (r - a_i - a_j) / (a_i + a_j), of the velocities. mari: of max(xi, 0) + regularisation, of the
    velocities relative to the flow and of its rate of strain.
/lubrication/inner_gap | number > 0 and < 1; default 0.001; if form kim-karrila; named inner gap of the
    lubrication | Of the form kim-karrila: gap below which the resistance stays constant.
/lubrication/outer_gap | number > 0 and < 1; default 0.05; if form kim-karrila; named outer gap of the
    lubrication | Of the form kim-karrila: gap beyond which there is none; must be larger than inner_gap.
/lubrication/regularisation | number > 0 and < 1; default 0.001; if form mari | Of the form mari: what is
    added to the gap.
/lubrication/outer_distance | number > 0; in length; if form mari | Of the form mari, which needs it: distance
    of the surfaces beyond which there is none; must be smaller than 1 - regularisation times the smallest
    radius.
)";

inline LubricationParameters read_lubrication(const SceneDocument& scene) {
  LubricationParameters lubrication;
  if (scene.at("/lubrication/form").get<std::string>() == "mari") {
    lubrication.form = LubricationParameters::Form::mari;
    lubrication.inner_gap = scene.number("/lubrication/regularisation");
    lubrication.outer_distance = scene.number("/lubrication/outer_distance");
    return lubrication;
  }
  lubrication.inner_gap = scene.number("/lubrication/inner_gap");
  lubrication.outer_gap = scene.number("/lubrication/outer_gap");
  if (lubrication.inner_gap >= lubrication.outer_gap) {
    scene.refuse("/lubrication/inner_gap", "must be a number > 0 and < /lubrication/outer_gap, which is " +
                                               shortened(scene.at("/lubrication/outer_gap")));
  }
  return lubrication;
}

// What is wrong with an outer distance beside these radii: where the logarithm of a gap is negative, so are
// resistances.
inline std::optional<std::string> fault_of_outer_distance(const LubricationParameters& lubrication,
                                                          double smallest_radius) {
  if (lubricated_gap(lubrication, 2 * smallest_radius).outer < 1) return std::nullopt;
  return fmt::format(
      "must be a number > 0 and < {:.6g}, which is 1 - /lubrication/regularisation times the smallest radius",
      (1 - lubrication.inner_gap) * smallest_radius);
}

}  // namespace peclet::engine
