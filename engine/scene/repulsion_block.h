// The block repulsion of a scene.
#pragma once

#include <optional>
#include <string>

#include "engine/flow/scene_document.h"
#include "engine/terms/repulsion.h"

namespace peclet::engine {

inline constexpr const char* repulsion_keys = R"(
/repulsion? | object | Repulsion of the surfaces, at distance h; absent: none.
/repulsion/form | one of exponential, screened; named form of the repulsion | exponential: energy strength *
    exp(-h / kappa). screened: force F a / a_0 * exp(-h / debye_length), in overlap as at h = 0, with a = 2
    a_i a_j / (a_i + a_j).
/repulsion/strength | number >= 0; in energy; if form exponential; named strength of the repulsion | Of the
    exponential form: energy of a pair that touches.
/repulsion/relative_length? | number > 0; if form exponential | Of the exponential form: kappa / (a_i + a_j);
    0.01 unless given.
/repulsion/force | number >= 0; in force; if form screened; named largest force of the repulsion | F, of the
    screened form: that of a touching pair with a = a_0.
/repulsion/debye_length | number > 0; in length; if form screened; named Debye length, κ^{-1} | Of the
    screened form, which needs it: the screening length.
/repulsion/reference_radius | number > 0; in length; if form screened | Of the screened form, which needs it:
    a_0.
/repulsion/cutoff_lengths | number > 0; default 20 | Distance h / kappa, or h / debye_length, beyond which
    there is none.
)";

// None with a strength or force of 0.
inline std::optional<RepulsionParameters> read_repulsion(const SceneDocument& scene) {
  RepulsionParameters repulsion;
  repulsion.cutoff_lengths = scene.number("/repulsion/cutoff_lengths");
  if (scene.at("/repulsion/form") == "screened") {
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
