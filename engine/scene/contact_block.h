// The block contact of a scene.
#pragma once

#include "engine/flow/scene_document.h"
#include "engine/terms/contact.h"

namespace peclet::engine {

inline constexpr const char* contact_keys = R"(
/contact? | object | Forces between overlapping spheres; absent: none.
/contact/normal_stiffness | number > 0; in force / length; named normal stiffness, k_n | Normal stiffness k_n.
/contact/normal_damping | number >= 0; in force time / length; default 0 | Normal damping.
/contact/friction? | number >= 0; named coefficient of friction, μ | Coefficient of sliding friction; absent
    (or 0): frictionless.
/contact/kinetic_friction? | number >= 0; if friction; named coefficient of kinetic friction, μ_k |
    Coefficient of kinetic friction, while a contact slides; at most that of friction, and with it only;
    absent: the same.
/contact/critical_load? | number >= 0; in force; if friction | Normal force F_CL below which a contact has no
    friction, which goes by what exceeds it; with friction only; absent (or 0): none.
/contact/largest_load? | number > 0; in force; if friction | Load of friction beyond which it grows no more,
    with friction only; absent: none.
/contact/tangential_stiffness? | number > 0; in force / length; if friction | Tangential stiffness, with
    friction only; 2/7 of the normal one unless given.
/contact/tangential_damping? | number >= 0; in force time / length; if friction | Tangential damping gamma_t,
    with friction only: gamma_t v_t pushes beside the tangential spring, and Coulomb's law limits both together;
    absent (or 0): none.
/contact/rolling_stiffness? | number >= 0; in force / length | Stiffness against rolling; absent (or 0): free
    rolling. Above 0 it needs friction above 0.
/contact/rolling_friction? | number >= 0; if rolling_stiffness; named coefficient of rolling friction, μ_r |
    Coefficient that caps rolling resistance, with rolling_stiffness only; that of sliding unless given.
)";

inline ContactParameters read_contact(const SceneDocument& scene) {
  ContactParameters contact;
  contact.normal_stiffness = scene.number("/contact/normal_stiffness");
  contact.normal_damping = scene.number("/contact/normal_damping");
  contact.friction = scene.number_or("/contact/friction", 0);
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
  contact.rolling_friction = scene.number_or("/contact/rolling_friction", contact.friction);
  return contact;
}

}  // namespace peclet::engine
