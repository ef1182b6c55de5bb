// Every key of a scene: the one list behind validation, schema/scene.schema.json and the manual's page.
#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "engine/scene/flow_block.h"
#include "engine/scene/law_blocks.h"
#include "engine/scene/observable_keys.h"
#include "engine/scene/particles_block.h"
#include "engine/scene/scene.h"
#include "engine/scene/start_block.h"

namespace peclet::engine {

namespace {

Keys run_keys() {
  Keys keys = {
      with_default(block("/integrator", "How the equations of motion are solved."), Json::object()),
      choice("/integrator/method",
             "explicit: velocity Verlet; implicit: steps that solve for the velocities. Unless given, "
             "implicit with lubrication and explicit without.",
             {"explicit", "implicit"}),
      {.pointer = "/integrator/timestep",
       .kind = KeyKind::number_or_auto,
       .meaning =
           "Time step; auto: half of the largest stable explicit one, or the implicit one whose error "
           "has been measured, and not more than a 32nd of the production window. An oscillation has a "
           "whole number of steps, 128 at least: the step is shortened to that.",
       .unit = "time",
       .default_value = "auto",
       .minimum = 0,
       .above_minimum = true},
      {.pointer = "/integrator/tolerance",
       .kind = KeyKind::number,
       .meaning = "Residual of the equations of an implicit step, relative to the motion, in the energy "
                  "norm; unless given 0.002, with noise 0.004.",
       .minimum = 0,
       .maximum = 5e-3,
       .above_minimum = true},
      block("/duration", "How long a realisation runs.", required),
  };
  const auto append = [&](const Keys& more) { keys.insert(keys.end(), more.begin(), more.end()); };
  append(duration_keys("/duration/equilibration", "Before anything is measured; a limit of 0 skips it.",
                       not_negative));
  append(duration_keys("/duration/production", "The window of all means.", positive));
  append({
      {.pointer = "/observables",
       .kind = KeyKind::array,
       .meaning = "What is measured.",
       .default_value = Json::array({"stress"}),
       .minimum_items = 1},
  });
  append(observable_keys());
  append({
      block("/files", "Files that a realisation leaves beside its result; absent: none."),
      {.pointer = "/files/final_configuration",
       .kind = KeyKind::boolean,
       .meaning =
           "final.xyz: cell, centres, radii, velocities and spins at the end of a completed realisation, "
           "as extended XYZ.",
       .default_value = false},
      {.pointer = "/files/final_checkpoint",
       .kind = KeyKind::boolean,
       .meaning =
           "final.checkpoint: all that a completed realisation needs to go on, with `peclet-engine run "
           "--extend`."},
  });
  append({
      with_default(block("/guard", "Limits that end a realisation as failed, or flag its result."),
                   Json::object()),
      with_default(positive("/guard/largest_overlap", "", "Overlap over the smaller radius of the pair."),
                   0.05),
      positive(
          "/guard/largest_displacement", "",
          "Displacement in one step, or in the smallest part of a divided implicit one, relative to rate y, "
          "over the smallest radius; 0.05 with explicit and 0.3 with implicit steps unless given."),
      with_default(positive("/guard/energy_imbalance", "",
                            "Energy that the finite step makes over the work of the flow; beyond it the "
                            "result has the warning timestep."),
                   0.3),
      with_default(positive("/guard/half_step_difference", "",
                            "Relative difference of the stress between steps and half steps, on samples; "
                            "beyond it the result has the warning timestep."),
                   0.03),
  });
  return keys;
}

struct KeyName {
  const char *pointer, *words, *symbol;
};

// What people call keys: all who show a scene take it from its schema.
constexpr KeyName key_names[] = {
    {"/peclet", "Péclet number", "Pe"},
    {"/volume_fraction", "volume fraction", "φ"},
    {"/addition/base_volume_fraction", "volume fraction before the addition", "φ_0"},
    {"/particles/count", "number of particles", "N"},
    {"/particles/density", "density of the particles", "ρ"},
    {"/particles/mixture/alpha", "share of grains in the solid volume", "α"},
    {"/fluid/viscosity", "viscosity of the fluid", "η"},
    {"/fluid/thermal_energy", "thermal energy", "k_B T"},
    {"/flow/shear_rate", "shear rate", "γ̇"},
    {"/flow/extension_rate", "extension rate", "ε̇"},
    {"/flow/stress", "shear stress", "σ"},
    {"/flow/oscillation/amplitude", "amplitude of the strain", "γ_0"},
    {"/flow/oscillation/frequency", "angular frequency", "ω"},
    {"/flow/cross_shear/amplitude", "amplitude of the strain across", "γ_0"},
    {"/flow/cross_shear/frequency", "angular frequency across", "ω"},
    {"/contact/normal_stiffness", "normal stiffness", "k_n"},
    {"/contact/friction", "coefficient of friction", "μ"},
    {"/contact/kinetic_friction", "coefficient of kinetic friction", "μ_k"},
    {"/contact/rolling_friction", "coefficient of rolling friction", "μ_r"},
    {"/lubrication/form", "form of the lubrication", ""},
    {"/lubrication/inner_gap", "inner gap of the lubrication", ""},
    {"/lubrication/outer_gap", "outer gap of the lubrication", ""},
    {"/repulsion/form", "form of the repulsion", ""},
    {"/repulsion/strength", "strength of the repulsion", ""},
    {"/repulsion/force", "largest force of the repulsion", ""},
    {"/repulsion/debye_length", "Debye length", "κ^{-1}"},
    {"/attraction/hamaker", "Hamaker constant", "A_H"}};

void name_keys(Keys& keys) {
  for (const auto& [pointer, words, symbol] : key_names) {
    const auto key = std::find_if(keys.begin(), keys.end(),
                                  [&, at = pointer](const Key& one) { return one.pointer == at; });
    if (key == keys.end()) throw std::logic_error(std::string("no key of a scene: ") + pointer);
    key->words = words;
    key->symbol = symbol;
  }
}

}  // namespace

const KeyTable& scene_keys() {
  static const KeyTable table = [] {
    Keys keys;
    const auto append = [&](const Keys& more) { keys.insert(keys.end(), more.begin(), more.end()); };
    append(particle_keys());
    append(flow_keys());
    for (const LawBlock& law : law_blocks) append(law.keys());
    append(start_keys());
    append(run_keys());
    name_keys(keys);
    return KeyTable("Scene of a peclet simulation", std::move(keys));
  }();
  return table;
}

}  // namespace peclet::engine
