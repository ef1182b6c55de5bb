// The block contact of a scene.
#pragma once

#include "engine/scene/keys.h"
#include "engine/scene/scene_document.h"
#include "engine/terms/contact.h"

namespace peclet::engine {

inline Keys contact_keys() {
  return {
      block("/contact", "Forces between overlapping spheres; absent: none."),
      positive("/contact/normal_stiffness", "force / length", "Normal stiffness k_n.", required),
      with_default(not_negative("/contact/normal_damping", "force time / length", "Normal damping."), 0),
      not_negative("/contact/friction", "", "Coefficient of sliding friction; absent (or 0): frictionless."),
      positive("/contact/tangential_stiffness", "force / length",
               "Tangential stiffness, with friction only; 2/7 of the normal one unless given."),
      not_negative(
          "/contact/rolling_stiffness", "force / length",
          "Stiffness against rolling; absent (or 0): free rolling. Above 0 it needs friction above 0."),
      not_negative(
          "/contact/rolling_friction", "",
          "Coefficient that caps rolling resistance, with rolling_stiffness only; that of sliding unless "
          "given."),
  };
}

inline ContactParameters read_contact(const SceneDocument& scene) {
  ContactParameters contact;
  contact.normal_stiffness = scene.number("/contact/normal_stiffness");
  contact.normal_damping = scene.number("/contact/normal_damping");
  contact.friction = scene.number_or("/contact/friction", 0);
  if (scene.has("/contact/tangential_stiffness") && !scene.has("/contact/friction")) {
    scene.refuse("/contact/tangential_stiffness", "must be left out without /contact/friction");
  }
  // 2/7: a homogeneous sphere's normal and tangential contact then oscillate with the same period.
  contact.tangential_stiffness =
      scene.number_or("/contact/tangential_stiffness", 2.0 / 7.0 * contact.normal_stiffness);
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
