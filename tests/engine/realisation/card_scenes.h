// Small scenes that a card can run, one of each kind of law.
#pragma once

#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "tests/engine/small_scene.h"

namespace peclet::engine {

// Returns the small scene with implicit steps and this patch; solutions have the tightest usual tolerance.
inline Json card_scene(const Json& patch = Json::object()) {
  return small_scene(together({Json::parse(R"({
    "particles": {"count": 100, "density": 0.01}, "volume_fraction": 0.5,
    "fluid": {"thermal_energy": null},
    "integrator": {"method": "implicit", "timestep": "auto", "tolerance": 1e-6},
    "guard": {"largest_overlap": 0.3, "largest_displacement": 0.5},
    "duration": {"equilibration": {"time": 0.2}, "production": {"time": 16}}})"),
                               patch}));
}

inline const Json with_noise = Json::parse(R"({"fluid": {"thermal_energy": 0.02}})");
inline const Json with_strong_noise = Json::parse(R"({"fluid": {"thermal_energy": 1}})");
inline const Json hard_core = Json::parse(R"({"contact": null, "repulsion": null})");
inline const Json without_rolling =
    Json::parse(R"({"contact": {"rolling_stiffness": null, "rolling_friction": null}})");
inline const Json without_repulsion = Json::parse(R"({"repulsion": null})");
inline const Json with_attraction = Json::parse(R"({"attraction": {"hamaker": 0.01, "cutoff": 0.1}})");
inline const Json with_critical_load = Json::parse(R"({"contact": {"critical_load": 2}})");
inline const Json with_kinetic_friction = Json::parse(R"({"contact": {"kinetic_friction": 0.2}})");
inline const Json with_more_damping = Json::parse(R"({"contact": {"normal_damping": 5}})");
inline const Json large_sizes_beside_small = Json::parse(R"({
    "particles": {"count": 200,
                  "species": [{"radius": 1, "volume_share": 0.4}, {"radius": 4, "volume_share": 0.6}]}})");

inline const Json few_spheres =
    Json::parse(R"({"particles": {"count": 8}, "lubrication": {"outer_gap": 0.3}})");

struct NamedScene {
  std::string name;
  Json scene;
};
inline void PrintTo(const NamedScene& of, std::ostream* out) { *out << of.name; }

// Returns scenes that together use every variant of the program for cards and every law.
inline const std::vector<NamedScene>& card_scenes() {
  static const std::vector<NamedScene> all = {
      {"Plain", card_scene(together({without_friction, without_repulsion}))},
      {"Friction", card_scene(together({without_rolling, without_repulsion}))},
      {"EveryLaw", card_scene(with_attraction)},
      {"Noise", card_scene(together({with_noise, without_friction}))},
      {"StrongNoise", card_scene(together({with_strong_noise, without_friction}))},
      {"NoiseAndSliding", card_scene(together({with_noise, without_rolling}))},
      {"NoiseAndRolling", card_scene(together({with_noise, with_attraction}))},
      {"CriticalLoad", card_scene(together({without_rolling, with_critical_load}))},
      {"KineticFriction", card_scene(with_kinetic_friction)},
      {"KineticFrictionAndNoise", card_scene(together({with_noise, without_rolling, with_kinetic_friction}))},
      {"Damping", card_scene(together({without_friction, with_more_damping}))},
      {"Strained", card_scene(together({strained_lubrication, without_friction}))},
      {"StrainedAndSliding", card_scene(together({strained_lubrication, without_rolling}))},
      {"StrainedAndRolling", card_scene(strained_lubrication)},
      {"StrainedNoise", card_scene(together({strained_lubrication, with_noise, without_friction}))},
      {"StrainedNoiseAndSliding", card_scene(together({strained_lubrication, with_noise, without_rolling}))},
      {"StrainedNoiseAndRolling", card_scene(together({strained_lubrication, with_noise}))},
      {"LargeBesideSmall", card_scene(large_sizes_beside_small)},
      {"LargeBesideSmallWithNoise", card_scene(together({large_sizes_beside_small, with_noise}))},
      // Their cell is so narrow that several images of a sphere are near.
      {"FewSpheres", card_scene(few_spheres)},
      {"FewSpheresWithNoise", card_scene(together({few_spheres, with_noise}))},
      {"WithoutLubrication", card_scene(Json::parse(R"({"lubrication": null})"))},
  };
  return all;
}

}  // namespace peclet::engine
