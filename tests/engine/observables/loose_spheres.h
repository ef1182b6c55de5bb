// Spheres in a box without a neighbour list, and one observable of them: configurations with known answers.
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "engine/kernels/pair_kinds.h"
#include "engine/observables/observable.h"
#include "engine/observables/scene_reading.h"
#include "engine/scene/scene.h"
#include "tests/engine/draws.h"
#include "tests/engine/small_scene.h"

namespace peclet::engine {

constexpr double edge = 10, timestep = 0.5;

// Returns `count` spheres of radii 1 and 2 in turn, in a cube at rest with springless contacts.
inline System loose_spheres(std::size_t count, double shear_rate = 0) {
  System system;
  std::vector<double> radius(count);
  for (std::size_t i = 0; i < count; ++i) radius[i] = i % 2 == 0 ? 1 : 2;
  system.particles = make_particles(radius, 1);
  system.box = PeriodicCell({edge, edge, edge}, simple_shear(shear_rate));
  return system;
}

// Builds the list of pairs within the range of the forces.
inline void build_list(System& system, const Physics& physics) {
  system.list = NeighbourList(range_table(make_pair_kinds(physics, {1, 2}), 2), 0.1);
  system.list.build(system.particles, system.box);
}

// Returns spheres of radius 1 in the same box.
inline System equal_spheres(std::size_t count, double radius = 1) {
  System system = loose_spheres(0);
  system.particles = make_particles(std::vector<double>(count, radius), 1);
  return system;
}

// Returns a scene at kT = 2 with one observable and its settings; at rest unless a rate is given.
inline Scene scene_with(const char* observable, const Json& settings = Json::object(),
                        double shear_rate = 0) {
  Json document = small_scene();
  document["fluid"]["thermal_energy"] = 2;
  document["flow"]["shear_rate"] = shear_rate;
  document["observables"] = {observable};
  if (!settings.empty()) document[observable] = settings;
  return read_scene(document, "scene.json");
}

// Returns the observable of the scene, for the spheres of `system` and a window of `steps` steps.
inline std::unique_ptr<Observable> observable_of(const Scene& scene, const System& system,
                                                 std::uint64_t steps, double step = timestep) {
  Scene own = scene;
  own.particles.count = system.particles.count();
  own.particles.species.clear();
  const double share = 1 / static_cast<double>(system.particles.count());
  for (const double radius : system.particles.radius) own.particles.species.push_back({radius, share});
  own.particles.shares = Particles::Shares::number;
  auto made = make_observables(own, {step, steps, system.box.lengths()}, "scene.json");
  EXPECT_EQ(made.size(), 1u);
  return std::move(made.front());
}

inline Vector3 place_in_box(Draws& draws) {
  return {draws.uniform(0, edge), draws.uniform(0, edge), draws.uniform(0, edge)};
}

inline void place_anywhere(System& system, Draws& draws) {
  for (std::size_t i = 0; i < system.particles.count(); ++i)
    system.particles.position.set(i, place_in_box(draws));
}

inline Json mean_of(const Observable& observable) {
  Json mean = Json::object();
  observable.add_to(mean);
  return mean;
}

inline Json blocks_of(const Observable& observable) {
  Json blocks = Json::object();
  observable.add_blocks_to(blocks);
  return blocks;
}

}  // namespace peclet::engine
