// The block lubrication of a scene.
#pragma once

#include <fmt/format.h>

#include <optional>
#include <string>

#include "engine/flow/scene_document.h"
#include "engine/terms/lubrication.h"

namespace peclet::engine {

inline Keys lubrication_keys() {
  return {
      block("/lubrication", "Squeeze, shear and pump modes between near spheres; absent: none."),
      must_be_given(named(
          choice(
              "/lubrication/form",
              "kim-karrila: resistances of the gap xi = 2 (r - a_i - a_j) / (a_i + a_j), of the velocities. "
              "mari: of max(xi, 0) + regularisation, of the velocities relative to the flow and of its rate "
              "of strain.",
              {"kim-karrila", "mari"}),
          "form of the lubrication")),
      fraction(
          named(
              positive("/lubrication/inner_gap", "",
                       "Of the form kim-karrila: gap below which the resistance stays constant; 0.001 unless "
                       "given."),
              "inner gap of the lubrication"),
          1),
      fraction(named(positive("/lubrication/outer_gap", "",
                              "Of the form kim-karrila: gap beyond which there is none; must be larger than "
                              "inner_gap; 0.05 unless given."),
                     "outer gap of the lubrication"),
               1),
      fraction(positive("/lubrication/regularisation", "",
                        "Of the form mari: what is added to the gap; 0.001 unless given."),
               1),
      positive(
          "/lubrication/outer_distance", "length",
          "Of the form mari, which needs it: distance of the surfaces beyond which there is none; must be "
          "smaller than 1 - regularisation times the smallest radius."),
  };
}

// The defaults of a form, into a document whose keys are valid.
inline void fill_lubrication(Json& document) {
  if (!document.contains("lubrication")) return;
  Json& block = document["lubrication"];
  const auto fill = [&](const char* key, double value) {
    if (!block.contains(key)) block[key] = value;
  };
  const LubricationParameters usual;
  if (block["form"] == "mari") {
    fill("regularisation", usual.inner_gap);
  } else {
    fill("inner_gap", usual.inner_gap);
    fill("outer_gap", usual.outer_gap);
  }
}

inline LubricationParameters read_mari_lubrication(const SceneDocument& scene) {
  for (const char* key : {"/lubrication/inner_gap", "/lubrication/outer_gap"}) {
    if (scene.has(key)) scene.refuse(key, "must be left out with the form mari");
  }
  const char* const distance = "/lubrication/outer_distance";
  if (!scene.has(distance)) scene.miss(distance, "must be given with the form mari");
  LubricationParameters lubrication;
  lubrication.form = LubricationParameters::Form::mari;
  lubrication.inner_gap = scene.number("/lubrication/regularisation");
  lubrication.outer_distance = scene.number(distance);
  return lubrication;
}

// Of a document with the defaults of its form.
inline LubricationParameters read_lubrication(const SceneDocument& scene) {
  if (scene.at("/lubrication/form").get<std::string>() == "mari") return read_mari_lubrication(scene);
  for (const char* key : {"/lubrication/regularisation", "/lubrication/outer_distance"}) {
    if (scene.has(key)) scene.refuse(key, "must be left out unless the form is mari");
  }
  const LubricationParameters lubrication{scene.number("/lubrication/inner_gap"),
                                          scene.number("/lubrication/outer_gap")};
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
