// The observables that a scene may ask for, and the windows they need.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/contract/refusal.h"
#include "tests/engine/observables/loose_spheres.h"

namespace peclet::engine {
namespace {

TEST(Observables, HaveNamesOfTheirOwn) {
  std::vector<std::string> names;
  for (const ObservableKind& kind : observable_kinds()) names.push_back(kind.name);
  std::ranges::sort(names);
  EXPECT_EQ(std::ranges::adjacent_find(names), names.end());
}

TEST(Observables, AreAbsentUnlessAskedFor) {
  const Scene scene = read_scene(small_scene(), "scene.json");
  EXPECT_TRUE(make_observables(scene, {timestep, 256, {edge, edge, edge}}, "scene.json").empty());
}

TEST(Observables, NeedAWindowWithSamples) {
  const Scene scene = scene_with("mean_squared_displacement", {{"interval", 20}});
  const System system = loose_spheres(2);
  EXPECT_THROW(observable_of(scene, system, 360), InputError);  // 9 samples
  EXPECT_NO_THROW(observable_of(scene, system, 361));           // 10
}

}  // namespace
}  // namespace peclet::engine
