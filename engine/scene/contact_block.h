// The block contact of a scene.
#pragma once

#include "engine/flow/scene_document.h"
#include "engine/terms/contact.h"

namespace peclet::engine {

inline Keys contact_keys() {
  return {
      block("/contact", "Forces between overlapping spheres; absent: none."),
      named(positive("/contact/normal_stiffness", "force / length", "Normal stiffness k_n.", required),
            "normal stiffness", "k_n"),
      with_default(not_negative("/contact/normal_damping", "force time / length", "Normal damping."), 0),
      named(not_negative("/contact/friction", "",
                         "Coefficient of sliding friction; absent (or 0): frictionless."),
            "coefficient of friction", "μ"),
      named(not_negative(
                "/contact/kinetic_friction", "",
                "Coefficient of kinetic friction, while a contact slides; at most that of friction, and with "
                "it only; absent: the same."),
            "coefficient of kinetic friction", "μ_k"),
      not_negative("/contact/critical_load", "force",
                   "Normal force F_CL below which a contact has no friction, which goes by what exceeds it; "
                   "with friction only; absent (or 0): none."),
      positive("/contact/largest_load", "force",
               "Load of friction beyond which it grows no more, with friction only; absent: none."),
      positive("/contact/tangential_stiffness", "force / length",
               "Tangential stiffness, with friction only; 2/7 of the normal one unless given."),
      not_negative("/contact/tangential_damping", "force time / length",
                   "Tangential damping gamma_t, with friction only: gamma_t v_t pushes beside the tangential "
                   "spring, and Coulomb's law limits both together; absent (or 0): none."),
      not_negative(
          "/contact/rolling_stiffness", "force / length",
          "Stiffness against rolling; absent (or 0): free rolling. Above 0 it needs friction above 0."),
      named(
          not_negative(
              "/contact/rolling_friction", "",
              "Coefficient that caps rolling resistance, with rolling_stiffness only; that of sliding unless "
              "given."),
          "coefficient of rolling friction", "μ_r"),
  };
}

inline ContactParameters read_contact(const SceneDocument& scene) {
  ContactParameters contact;
  contact.normal_stiffness = scene.number("/contact/normal_stiffness");
  contact.normal_damping = scene.number("/contact/normal_damping");
  contact.friction = scene.number_or("/contact/friction", 0);
  for (const char* key : {"/contact/tangential_stiffness", "/contact/kinetic_friction",
                          "/contact/critical_load", "/contact/largest_load", "/contact/tangential_damping"}) {
    if (scene.has(key) && !scene.has("/contact/friction")) {
      scene.refuse(key, "must be left out without /contact/friction");
    }
  }
  contact.kinetic_friction = scene.number_or("/contact/kinetic_friction", contact.kinetic_friction);
  if (scene.has("/contact/kinetic_friction") && contact.kinetic_friction > contact.friction) {
    scene.refuse("/contact/kinetic_friction", "must be a number >= 0 and <= /contact/friction, which is " +
                                                  shortened(scene.at("/contact/friction")));
  }
  contact.critical_load = scene.number_or("/contact/critical_load", contact.critical_load);
  contact.largest_load = scene.number_or("/contact/largest_load", contact.largest_load);
  // 2/7: a homogeneous sphere's normal and tangential contact then oscillate with the same period.
  contact.tangential_stiffness =
      scene.number_or("/contact/tangential_stiffness", 2.0 / 7.0 * contact.normal_stiffness);
  contact.tangential_damping = scene.number_or("/contact/tangential_damping", 0);
  contact.rolling_stiffness = scene.number_or("/contact/rolling_stiffness", 0);
  if (contact.rolling_stiffness > 0 && contact.friction <= 0) {
    scene.refuse("/contact/rolling_stiffness", "must be 0 or left out unless /contact/friction is > 0");
  }
  if (scene.has("/contact/rolling_friction") && !scene.has("/contact/rolling_stiffness")) {
    scene.refuse("/contact/rolling_friction", "must be left out without /contact/rolling_stiffness");
  }
  contact.rolling_friction = scene.number_or("/contact/rolling_friction", contact.friction);
  return contact;
}

}  // namespace peclet::engine
