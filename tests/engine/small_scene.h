// A scene with many events in a few hundred steps: frictional contacts form and break, the list is rebuilt,
// the box flips, noise is drawn.
#pragma once

#include "contract/json.h"

namespace peclet::engine {

// Returns a scene of 60 spheres in fast shear. A wide inner gap allows a long step: dt = 0.002, strain 0.004
// a step, 100 steps of equilibration and 320 of production. Patched scenes have the same packing and noise.
inline Json small_scene() {
  return Json::parse(R"({
    "particles": {"count": 60, "density": 0.1,
                  "species": [{"radius": 1, "volume_share": 1}, {"radius": 1.4, "volume_share": 1}]},
    "volume_fraction": 0.45,
    "seeds_in_common": true,
    "fluid": {"viscosity": 0.1, "thermal_energy": 0.02},
    "flow": {"shear_rate": 2},
    "contact": {"normal_stiffness": 1e4, "friction": 0.5, "normal_damping": 0.5,
                "rolling_stiffness": 700, "rolling_friction": 0.2},
    "lubrication": {"form": "kim-karrila", "inner_gap": 0.03, "outer_gap": 0.1},
    "repulsion": {"form": "exponential", "strength": 0.1, "relative_length": 0.01, "cutoff_lengths": 5},
    "integrator": {"method": "explicit", "timestep": 0.002},
    "guard": {"largest_overlap": 0.2, "largest_displacement": 0.2},
    "duration": {"equilibration": {"time": 0.2}, "production": {"time": 0.64}}})");
}

inline Json small_scene(const Json& patch) {
  Json scene = small_scene();
  scene.merge_patch(patch);
  return scene;
}

// Returns several patches as one, which still has their nulls.
inline Json together(const std::vector<Json>& patches) {
  Json all = Json::object();
  for (const Json& patch : patches) all.update(patch, /*merge_objects=*/true);
  return all;
}

// Patches of the small scene. Light spheres let large steps resolve part of the range of their inertia.
inline const Json implicit_and_light =
    Json::parse(R"({"integrator": {"method": "implicit"}, "particles": {"density": 0.01}})");
inline const Json without_noise = Json::parse(R"({"fluid": {"thermal_energy": null}})");
inline const Json without_friction =
    Json::parse(R"({"contact": {"friction": null, "rolling_stiffness": null, "rolling_friction": null}})");
inline const Json elastic_contacts =
    together({without_friction, Json::parse(R"({"contact": {"normal_damping": null}})")});
inline const Json at_rest = Json::parse(R"({"flow": {"shear_rate": 0}})");
inline const Json strained_lubrication =
    Json::parse(R"({"lubrication": {"form": "mari", "inner_gap": null, "outer_gap": null,
                                                   "regularisation": 0.03, "outer_distance": 0.1}})");

}  // namespace peclet::engine
