// law_blocks has keys and readers of the blocks of a scene that are laws of pairs, in the manual's order.
#pragma once

#include <fmt/format.h>

#include "engine/scene/scene.h"

namespace peclet::engine {

inline constexpr const char* contact_keys = R"(
/contact? | object | Forces between overlapping spheres; absent: none.
/contact/normal_stiffness | number > 0; in force / length; named normal stiffness, k_n | Normal stiffness k_n.
/contact/normal_damping | number >= 0; in force time / length; default 0 | Normal damping.
/contact/friction? | number >= 0; named coefficient of friction, μ | Coefficient of sliding friction; absent
    (or 0): frictionless.
/contact/kinetic_friction? | number >= 0; if friction; named coefficient of kinetic friction, μ_k |
    Coefficient of kinetic friction, while a contact slides; at most that of friction, and with it only;
    absent: equal to friction.
/contact/critical_load? | number >= 0; in force; if friction | Critical load F_CL: the load of friction is the
    part of the normal force above it; with friction only; absent: 0.
/contact/largest_load? | number > 0; in force; if friction | Largest load of friction, with friction only;
    absent: unlimited.
/contact/tangential_stiffness? | number > 0; in force / length; if friction | Tangential stiffness, with
    friction only; 2/7 of the normal one unless given.
/contact/tangential_damping? | number >= 0; in force time / length; if friction | Tangential damping gamma_t,
    with friction only: gamma_t v_t adds to the force of the tangential spring, and Coulomb's law limits their
    sum; absent (or 0): none.
/contact/rolling_stiffness? | number >= 0; in force / length | Stiffness against rolling; absent (or 0): free
    rolling. Above 0 it needs friction above 0.
/contact/rolling_friction? | number >= 0; if rolling_stiffness; named coefficient of rolling friction, μ_r |
    Coefficient that caps rolling resistance, with rolling_stiffness only; that of sliding unless given.
)";

inline void read_contact(const SceneDocument& scene, Physics& physics) {
  ContactParameters& contact = physics.contact.emplace();
  contact.normal_stiffness = scene.number("/contact/normal_stiffness");
  contact.normal_damping = scene.number("/contact/normal_damping");
  contact.friction = scene.number_or("/contact/friction", 0);
  contact.kinetic_friction = scene.number_or("/contact/kinetic_friction", contact.kinetic_friction);
  if (scene.has("/contact/kinetic_friction") && contact.kinetic_friction > contact.friction) {
    scene.refuse("/contact/kinetic_friction", "must be a number >= 0 and <= /contact/friction, which is {}",
                 shortened(scene.at("/contact/friction")));
  }
  contact.critical_load = scene.number_or("/contact/critical_load", contact.critical_load);
  contact.largest_load = scene.number_or("/contact/largest_load", contact.largest_load);
  // The ratio 2/7 gives normal and tangential contacts of homogeneous spheres the same period.
  contact.tangential_stiffness =
      scene.number_or("/contact/tangential_stiffness", 2.0 / 7.0 * contact.normal_stiffness);
  contact.tangential_damping = scene.number_or("/contact/tangential_damping", 0);
  contact.rolling_stiffness = scene.number_or("/contact/rolling_stiffness", 0);
  if (contact.rolling_stiffness > 0 && contact.friction <= 0) {
    scene.refuse("/contact/rolling_stiffness", "must be 0 or left out unless /contact/friction is > 0");
  }
  contact.rolling_friction = scene.number_or("/contact/rolling_friction", contact.friction);
}

inline constexpr const char* lubrication_keys = R"(
/lubrication? | object | Squeeze, shear and pump modes between near spheres; absent: none.
/lubrication/form | one of kim-karrila, mari; named form of the lubrication | kim-karrila: resistance at the
    gap xi = 2 (r - a_i - a_j) / (a_i + a_j) to the velocities. mari: resistance at the gap max(xi, 0) +
    regularisation to the velocities relative to the flow and to its rate of strain.
/lubrication/inner_gap | number > 0 and < 1; default 0.001; if form kim-karrila; named inner gap of the
    lubrication | Form kim-karrila: gap below which the resistance is constant.
/lubrication/outer_gap | number > 0 and < 1; default 0.05; if form kim-karrila; named outer gap of the
    lubrication | Form kim-karrila: gap beyond which lubrication ends; must be larger than inner_gap.
/lubrication/regularisation | number > 0 and < 1; default 0.001; if form mari | Form mari: number that is
    added to the gap.
/lubrication/outer_distance | number > 0; in length; if form mari | Form mari, required: distance of the
    surfaces beyond which lubrication ends; must be smaller than (1 - regularisation) times the smallest
    radius.
)";

inline void read_lubrication(const SceneDocument& scene, Physics& physics) {
  LubricationParameters& lubrication = physics.lubrication.emplace();
  if (scene.at("/lubrication/form").get<std::string>() == "mari") {
    lubrication.form = LubricationParameters::Form::mari;
    lubrication.inner_gap = scene.number("/lubrication/regularisation");
    lubrication.outer_distance = scene.number("/lubrication/outer_distance");
    return;
  }
  lubrication.inner_gap = scene.number("/lubrication/inner_gap");
  lubrication.outer_gap = scene.number("/lubrication/outer_gap");
  if (lubrication.inner_gap >= lubrication.outer_gap) {
    scene.refuse("/lubrication/inner_gap", "must be a number > 0 and < /lubrication/outer_gap, which is {}",
                 shortened(scene.at("/lubrication/outer_gap")));
  }
}

// Returns the fault of an outer distance for this smallest radius; empty if it has no fault. Resistances
// would be negative where the logarithm of the gap is.
inline std::optional<std::string> fault_of_outer_distance(const LubricationParameters& lubrication,
                                                          double smallest_radius) {
  if (lubricated_gap(lubrication, 2 * smallest_radius).outer < 1) return std::nullopt;
  return fmt::format(
      "must be a number > 0 and < {:.6g}, which is (1 - /lubrication/regularisation) times the smallest "
      "radius",
      (1 - lubrication.inner_gap) * smallest_radius);
}

inline constexpr const char* repulsion_keys = R"(
/repulsion? | object | Repulsion of the surfaces, at distance h; absent: none.
/repulsion/form | one of exponential, screened; named form of the repulsion | exponential: energy strength *
    exp(-h / kappa). screened: force F a / a_0 * exp(-h / debye_length), constant in overlap, with a = 2
    a_i a_j / (a_i + a_j).
/repulsion/strength | number >= 0; in energy; if form exponential; named strength of the repulsion | Form
    exponential: energy of a touching pair.
/repulsion/relative_length? | number > 0; if form exponential | Form exponential: kappa / (a_i + a_j); 0.01
    unless given.
/repulsion/force | number >= 0; in force; if form screened; named largest force of the repulsion | Form
    screened: the force F of a touching pair with a = a_0.
/repulsion/debye_length | number > 0; in length; if form screened; named Debye length, κ^{-1} | Form screened,
    required: the screening length.
/repulsion/reference_radius | number > 0; in length; if form screened | Form screened, required: a_0.
/repulsion/cutoff_lengths | number > 0; default 20 | Distance h / kappa, or h / debye_length, beyond which the
    repulsion ends.
)";

// Reads the repulsion; one with a strength or force of 0 is left out.
inline void read_repulsion(const SceneDocument& scene, Physics& physics) {
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
  if (repulsion.strength + repulsion.force > 0) physics.repulsion = repulsion;
}

inline constexpr const char* attraction_keys = R"(
/attraction? | object | Van der Waals attraction of the surfaces, at distance h: force A_H a / (12 (h^2 +
    eps^2)), constant in overlap, with a = 2 a_i a_j / (a_i + a_j); absent: none.
/attraction/hamaker | number >= 0; in energy; named Hamaker constant, A_H | Hamaker constant A_H.
/attraction/regularisation | number > 0; default 0.01 | eps / a.
/attraction/cutoff | number > 0; in length | Distance h beyond which the attraction ends.
)";

// Reads the attraction; one with a constant of 0 is left out.
inline void read_attraction(const SceneDocument& scene, Physics& physics) {
  if (!(scene.number("/attraction/hamaker") > 0)) return;
  physics.attraction = {scene.number("/attraction/hamaker"), scene.number("/attraction/regularisation"),
                        scene.number("/attraction/cutoff")};
}

struct LawBlock {
  const char* name;
  const char* keys;
  void (*read)(const SceneDocument& scene, Physics& physics);  // requires the block
};

inline constexpr LawBlock law_blocks[] = {
    {"contact", contact_keys, read_contact},
    {"lubrication", lubrication_keys, read_lubrication},
    {"repulsion", repulsion_keys, read_repulsion},
    {"attraction", attraction_keys, read_attraction},
};

}  // namespace peclet::engine
