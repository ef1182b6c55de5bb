// The block repulsion of a scene.
#pragma once

#include <optional>
#include <string>

#include "engine/flow/scene_document.h"
#include "engine/terms/repulsion.h"

namespace peclet::engine {

inline Keys repulsion_keys() {
  Key force = named(not_negative("/repulsion/force", "force",
                                 "F, of the screened form: that of a touching pair with a = a_0."),
                    "largest force of the repulsion");
  force.instead_of = "strength";
  return {
      block("/repulsion", "Repulsion of the surfaces, at distance h; absent: none."),
      must_be_given(
          named(choice("/repulsion/form",
                       "exponential: energy strength * exp(-h / kappa). screened: force F a / a_0 * "
                       "exp(-h / debye_length), in overlap as at h = 0, with a = 2 a_i a_j / (a_i + a_j).",
                       {"exponential", "screened"}),
                "form of the repulsion")),
      named(not_negative("/repulsion/strength", "energy",
                         "Of the exponential form: energy of a pair that touches.", required),
            "strength of the repulsion"),
      positive("/repulsion/relative_length", "",
               "Of the exponential form: kappa / (a_i + a_j); 0.01 unless given."),
      force,
      named(positive("/repulsion/debye_length", "length",
                     "Of the screened form, which needs it: the screening length."),
            "Debye length", "κ^{-1}"),
      positive("/repulsion/reference_radius", "length", "Of the screened form, which needs it: a_0."),
      with_default(positive("/repulsion/cutoff_lengths", "",
                            "Distance h / kappa, or h / debye_length, beyond which there is none."),
                   20),
  };
}

// None with a strength or force of 0.
inline std::optional<RepulsionParameters> read_repulsion(const SceneDocument& scene) {
  const std::string form = scene.at("/repulsion/form").get<std::string>();
  const bool screened = form == "screened";
  for (const char* key : {"/repulsion/strength", "/repulsion/relative_length"}) {
    if (screened && scene.has(key)) scene.refuse(key, "must be left out with the form screened");
  }
  for (const char* key : {"/repulsion/force", "/repulsion/debye_length", "/repulsion/reference_radius"}) {
    if (!screened && scene.has(key)) scene.refuse(key, "must be left out unless the form is screened");
    if (screened && !scene.has(key)) scene.miss(key, "must be given with the form screened");
  }
  RepulsionParameters repulsion;
  repulsion.cutoff_lengths = scene.number("/repulsion/cutoff_lengths");
  if (screened) {
    repulsion.form = RepulsionParameters::Form::screened;
    repulsion.force = scene.number("/repulsion/force");
    repulsion.debye_length = scene.number("/repulsion/debye_length");
    repulsion.reference_radius = scene.number("/repulsion/reference_radius");
  } else {
    repulsion.strength = scene.number("/repulsion/strength");
    repulsion.relative_length = scene.number_or("/repulsion/relative_length", repulsion.relative_length);
  }
  if (!(repulsion.strength + repulsion.force > 0)) return std::nullopt;
  return repulsion;
}

}  // namespace peclet::engine
